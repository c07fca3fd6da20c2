// Attributes on the wire: what is announced of them is what they are, and what a stranger announces is checked.
#include "conversion/attribute_conversion.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>

#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::conversion {
namespace {

std::string refusal(const auto& attempt) {
    try {
        attempt();
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return {};
}

TEST(AttributeConversion, KeepsEveryTypeAndRefusesOthersWithTheirNumbers) {
    for (const ElementType type : choices<ElementType>) {
        EXPECT_EQ(from_wire(attribute_type(type)), type);
        EXPECT_EQ(from_wire(element_type(type)), type);
        EXPECT_EQ(static_cast<int>(attribute_type(type)), static_cast<int>(element_type(type)));
    }
    for (const int number : {0, 3, 6, -1}) {
        const std::string words = "type " + std::to_string(number) + " is none that this version knows";
        EXPECT_NE(refusal([&] { from_wire(static_cast<v1::AttributeType>(number)); }).find(words), std::string::npos);
        EXPECT_NE(refusal([&] { from_wire(static_cast<v1::ElementType>(number)); }).find(words), std::string::npos);
    }
}

TEST(AttributeConversion, KeepsWishesAndFillsInTheirBits) {
    const std::vector<AttributeWish> wishes{{"velocity", 0}, {"age", 16}, {"", 3}};
    EXPECT_EQ(attribute_wishes(to_wire(std::span(wishes))), wishes);
    AttributeWishes wire;
    wire.Add()->set_name("speed");
    EXPECT_EQ(attribute_wishes(wire), (std::vector<AttributeWish>{{"speed", 8}}));
    EXPECT_TRUE(attribute_wishes({}).empty());
}

TEST(AttributeConversion, RefusesWishesThatNoSessionCanGrant) {
    const auto refused = [](const std::vector<AttributeWish>& wishes) {
        return refusal([&] { to_wire(std::span(wishes)); });
    };
    EXPECT_NE(refused({{"age", 17}}).find("'age' has 17 bits, must have 1 to 16, or 0"), std::string::npos);
    EXPECT_NE(refused({{"age", -1}}).find("bits"), std::string::npos);
    EXPECT_NE(refused({{"age", 8}, {"age", 4}}).find("'age' comes twice"), std::string::npos);
    EXPECT_NE(refused({{"Age", 8}}).find("the name of wished attribute 0 must be"), std::string::npos);
    EXPECT_NE(refused({{"\xFF", 8}}).find("the name of wished attribute 0 must be"), std::string::npos);
    EXPECT_NE(refused({{std::string(65, 'a'), 8}}).find("1 to 64 of a-z, 0-9 and _"), std::string::npos);
    std::vector<AttributeWish> many;
    for (char c = 'a'; c <= 'q'; ++c) many.push_back({std::string(1, c), 8});
    EXPECT_NE(refused(many).find("17 wished attributes; at most 16"), std::string::npos);
}

Mesh mesh_with_attributes() {
    Mesh mesh;
    mesh.vertices.resize(2);
    const auto add = [&](const char* name, ElementType type, std::size_t components) {
        MeshAttribute& attribute = mesh.attributes.emplace_back();
        attribute.name = name;
        attribute.type = type;
        attribute.components = components;
        attribute.data.assign(2 * attribute.element_bytes(), std::byte{0});
    };
    add("velocity", ElementType::float32, 3);
    add("color", ElementType::uint8, 4);
    add("id", ElementType::uint32, 1);
    add("age", ElementType::float32, 1);
    const float last = 2.5F;
    std::memcpy(mesh.attributes[0].data.data() + 5 * sizeof(float), &last, sizeof last);
    return mesh;
}

TEST(AttributeConversion, AnnouncesAllAndTellsThoseThatBricksCarry) {
    const Mesh mesh = mesh_with_attributes();
    const std::vector<AttributeRange> ranges = attribute_ranges(mesh);
    const std::vector<AttributeWish> wishes{{"id", 8}, {"velocity", 12}, {"age", 0}};
    const std::vector<CodedAttribute> coded = coded_attributes(mesh, ranges, wishes);
    v1::MeshBegin message;
    to_wire(mesh, ranges, coded, message);
    ASSERT_EQ(message.attributes_size(), 4);
    EXPECT_EQ(message.attributes(0).maximum(2), 2.5);
    EXPECT_EQ(message.attributes(0).bits(), 12U);
    EXPECT_EQ(message.attributes(0).coded_maximum(2), 2.5F);
    EXPECT_FALSE(message.attributes(1).has_bits());
    EXPECT_EQ(message.attributes(1).minimum_size(), 4);
    EXPECT_TRUE(message.attributes(2).has_bits());
    EXPECT_EQ(message.attributes(3).coded_minimum_size(), 0);
    v1::MeshBegin received;
    ASSERT_TRUE(received.ParseFromString(message.SerializeAsString()));
    EXPECT_EQ(coded_attributes(received), coded);

    v1::MeshBegin empty;
    to_wire(mesh, {}, coded, empty);
    EXPECT_EQ(empty.attributes(0).minimum_size(), 0);
    EXPECT_EQ(coded_attributes(empty), coded);
}

TEST(AttributeConversion, BelievesNothingThatAServerAnnounces) {
    v1::MeshBegin good;
    {
        const Mesh mesh = mesh_with_attributes();
        const std::vector<AttributeRange> ranges = attribute_ranges(mesh);
        const std::vector<AttributeWish> all{{"", 8}};
        to_wire(mesh, ranges, coded_attributes(mesh, ranges, all), good);
    }
    EXPECT_EQ(coded_attributes(good).size(), 4U);
    const auto expect_refused = [&](const std::string& words, const auto& change) {
        v1::MeshBegin bad = good;
        change(bad);
        const std::string said = refusal([&] { coded_attributes(bad); });
        EXPECT_NE(said.find(words), std::string::npos) << said;
    };
    using Begin = v1::MeshBegin;
    const double infinity = std::numeric_limits<double>::infinity();
    expect_refused("comes twice", [](Begin& m) { m.mutable_attributes(1)->set_name("velocity"); });
    expect_refused("the name of attribute 0", [](Begin& m) { m.mutable_attributes(0)->set_name(""); });
    expect_refused("the name of attribute 0", [](Begin& m) { m.mutable_attributes(0)->set_name("a b"); });
    expect_refused("type 0", [](Begin& m) { m.mutable_attributes(0)->set_type(v1::ATTRIBUTE_TYPE_UNSPECIFIED); });
    expect_refused("type 9", [](Begin& m) { m.mutable_attributes(0)->set_type(static_cast<v1::AttributeType>(9)); });
    expect_refused("float32 of 2 components", [](Begin& m) { m.mutable_attributes(0)->set_components(2); });
    expect_refused("float32 of 4294967295 components",
                   [](Begin& m) { m.mutable_attributes(0)->set_components(0xFFFFFFFF); });
    expect_refused("uint32 of 3 components", [](Begin& m) { m.mutable_attributes(2)->set_components(3); });
    expect_refused("must have 3 of each", [](Begin& m) { m.mutable_attributes(0)->add_minimum(1.0); });
    expect_refused("finite and ascending", [](Begin& m) { m.mutable_attributes(3)->set_minimum(0, 9.0); });
    expect_refused("finite and ascending", [&](Begin& m) { m.mutable_attributes(3)->set_maximum(0, infinity); });
    expect_refused("17 bits", [](Begin& m) { m.mutable_attributes(0)->set_bits(17); });
    expect_refused("only float32 is rounded", [](Begin& m) { m.mutable_attributes(1)->set_bits(8); });
    expect_refused("the coded range", [](Begin& m) { m.mutable_attributes(0)->clear_coded_minimum(); });
    expect_refused("the coded range", [](Begin& m) { m.mutable_attributes(0)->add_coded_maximum(1.0F); });
    expect_refused("the coded range", [](Begin& m) {
        m.mutable_attributes(3)->set_coded_maximum(0, std::numeric_limits<float>::quiet_NaN());
    });
    expect_refused("17 attributes; at most 16", [](Begin& m) {
        while (m.attributes_size() < 17) *m.add_attributes() = m.attributes(0);
    });
}

}  // namespace
}  // namespace meniscus::conversion
