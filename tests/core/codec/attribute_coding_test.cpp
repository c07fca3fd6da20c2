// Attributes travel with their vertices: exactly, or within half a step of a range that stays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/meniscus.hpp"
#include "support/damaged_bricks.hpp"
#include "support/float_bits.hpp"
#include "support/mesh_attributes.hpp"
#include "support/particles.hpp"
#include "support/refusal.hpp"

namespace meniscus {
namespace {

constexpr float largest = std::numeric_limits<float>::max();
constexpr float smallest = std::numeric_limits<float>::denorm_min();

const Mesh& sample() {
    static const Mesh mesh = [] {
        Mesh made = test::reconstruct(test::default_settings(), test::splash(62, 8).frame());
        test::add_attributes(made);
        return made;
    }();
    return mesh;
}

CodingOptions options_for(const Mesh& mesh, std::span<const AttributeWish> wishes, int speed = 10) {
    CodingOptions options;
    options.speed = speed;
    options.attributes = coded_attributes(mesh, attribute_ranges(mesh), wishes);
    return options;
}

Mesh through_bricks(const Mesh& mesh, const CodingOptions& options) {
    std::vector<DecodedBrick> bricks;
    for (std::size_t b = 0; b < mesh.bricks.size(); ++b)
        bricks.push_back(decode_brick(encode_brick(mesh, b, options), mesh.offset_bits, options.attributes));
    return weld_bricks(bricks, mesh.cell_size, mesh.offset_bits);
}

void expect_same_attributes(const Mesh& a, const Mesh& b) {
    ASSERT_EQ(a.attributes.size(), b.attributes.size());
    for (std::size_t i = 0; i < a.attributes.size(); ++i) {
        SCOPED_TRACE(a.attributes[i].name);
        EXPECT_EQ(a.attributes[i].name, b.attributes[i].name);
        EXPECT_EQ(a.attributes[i].type, b.attributes[i].type);
        EXPECT_EQ(a.attributes[i].components, b.attributes[i].components);
        EXPECT_TRUE(a.attributes[i].data == b.attributes[i].data);
    }
}

/// A mesh that has these numbers at its vertices, one each, and no triangles.
Mesh points_with(const std::vector<float>& numbers) {
    Mesh mesh;
    mesh.vertices.resize(numbers.size());
    mesh.attributes.push_back(test::attribute_of("value", ElementType::float32, 1, numbers));
    return mesh;
}

CodedAttribute coded(const Mesh& mesh, int bits) {
    const AttributeWish wish{"value", bits};
    return coded_attributes(mesh, attribute_ranges(mesh), {&wish, 1}).at(0);
}

std::vector<float> rounded(Mesh mesh, int bits) {
    const AttributeWish wish{"value", bits};
    round_attributes(mesh, {&wish, 1});
    return test::numbers_of<float>(mesh.attributes.at(0));
}

template <class Number>
void expect_ranges_of(ElementType type, std::size_t components, std::mt19937& random) {
    for (const std::size_t count : {1U, 2U, 4U, 11U, 12U, 13U, 100U}) {
        std::vector<Number> numbers(count * components);
        for (Number& number : numbers)
            number = std::is_same_v<Number, float>
                         ? static_cast<Number>(std::uniform_real_distribution<float>(-9.0F, 9.0F)(random))
                         : static_cast<Number>(random());
        Mesh mesh;
        mesh.vertices.resize(count);
        mesh.attributes.push_back(test::attribute_of("value", type, components, numbers));
        const AttributeRange range = attribute_ranges(mesh).at(0);
        for (std::size_t c = 0; c < components; ++c) {
            std::vector<Number> own;
            for (std::size_t i = c; i < numbers.size(); i += components) own.push_back(numbers[i]);
            EXPECT_EQ(range.minimum[c], *std::ranges::min_element(own)) << name_of(type) << ' ' << count;
            EXPECT_EQ(range.maximum[c], *std::ranges::max_element(own)) << name_of(type) << ' ' << count;
        }
    }
}

TEST(AttributeRange, IsTheSmallestAndTheLargestValueOfEachComponent) {
    std::mt19937 random(1);
    for (const std::size_t components : {1U, 3U, 4U}) {
        expect_ranges_of<float>(ElementType::float32, components, random);
        expect_ranges_of<std::uint8_t>(ElementType::uint8, components, random);
    }
    expect_ranges_of<std::int32_t>(ElementType::int32, 1, random);
    expect_ranges_of<std::uint32_t>(ElementType::uint32, 1, random);
}

TEST(AttributeRange, OfZerosIsZeroWithoutASignInAnyOrder) {
    for (const std::vector<float>& zeros : {std::vector{0.0F, -0.0F}, std::vector{-0.0F, 0.0F}, std::vector{-0.0F}}) {
        const AttributeRange range = attribute_ranges(points_with(zeros)).at(0);
        EXPECT_FALSE(std::signbit(range.minimum[0]));
        EXPECT_FALSE(std::signbit(range.maximum[0]));
    }
}

TEST(AttributeRange, IsNoneWithoutVertices) {
    const Mesh empty = points_with({});
    EXPECT_TRUE(attribute_ranges(empty).empty());
    const CodedAttribute form = coded(empty, 8);
    EXPECT_EQ(form.bits, 8);
    EXPECT_EQ(form.minimum, form.maximum);
}

TEST(CodedRange, HoldsTheValuesAndIsAtMostAnEighthWiderOnEachSide) {
    std::mt19937 random(2);
    for (int i = 0; i < 10'000; ++i) {
        std::vector<float> ends(2);
        for (float& end : ends) do
                end = test::float_of(static_cast<std::uint32_t>(random()));
            while (!std::isfinite(end));
        if (i % 2 == 0) ends[1] = std::nextafter(ends[0], largest) + static_cast<float>(i % 8) * std::abs(ends[0]) / 9;
        if (!std::isfinite(ends[1])) continue;
        const auto [least, most] = std::minmax(ends[0], ends[1]);
        const CodedAttribute form = coded(points_with(ends), 8);
        ASSERT_LE(form.minimum[0], least);
        ASSERT_GE(form.maximum[0], most);
        ASSERT_TRUE(std::isfinite(form.minimum[0]) && std::isfinite(form.maximum[0]));
        const double allowed = (double{most} - least) / 8.0;
        ASSERT_LE(double{least} - form.minimum[0], allowed);
        ASSERT_LE(double{form.maximum[0]} - most, allowed);
    }
}

TEST(CodedRange, StaysTheSameWhenValuesChangeALittle) {
    const CodedAttribute form = coded(points_with({-1.03F, 0.4F, 2.9F}), 8);
    EXPECT_EQ(form.minimum[0], -1.25F);
    EXPECT_EQ(form.maximum[0], 3.0F);
    EXPECT_EQ(coded(points_with({-1.1F, 0.5F, 2.8F}), 8), form);
    EXPECT_EQ(coded(points_with({-1.2F, 2.76F}), 8).minimum, form.minimum);
    // Like the largest speed of water, which differs in each frame.
    int changes = 0;
    CodedAttribute before = form;
    for (int frame = 0; frame < 100; ++frame) {
        const CodedAttribute now = coded(points_with({0.0F, 2.875F + 0.12F * std::sin(static_cast<float>(frame))}), 8);
        changes += now == before ? 0 : 1;
        before = now;
    }
    EXPECT_EQ(changes, 1) << "the first one alone";
}

TEST(CodedRange, GivesConstantsBackExactly) {
    for (const float constant : {0.0F, 0.1F, -3.7F, smallest, largest, -largest, 1e-30F})
        for (const int bits : {1, 8, 16}) {
            const Mesh mesh = points_with({constant, constant, constant});
            EXPECT_EQ(coded(mesh, bits).minimum[0], constant);
            EXPECT_EQ(coded(mesh, bits).maximum[0], constant);
            EXPECT_EQ(rounded(mesh, bits), std::vector(3, constant));
        }
}

TEST(CodedRange, RoundsByHalfAStepAtMost) {
    const std::vector<std::pair<float, float>> ends{{0.0F, 1.0F},        {-2.5F, 7.0F},
                                                    {1e6F, 1e6F + 0.5F}, {-largest, largest},
                                                    {0.0F, smallest},    {-3 * smallest, 9 * smallest},
                                                    {-1.0F, 3.4e38F},    {-1e-30F, 1e-28F}};
    std::mt19937 random(3);
    for (const auto& [low, high] : ends) {
        std::vector<float> numbers{low, high};
        for (int i = 0; i < 1000; ++i) {
            const double at = std::uniform_real_distribution<double>(0.0, 1.0)(random);
            numbers.push_back(std::clamp(static_cast<float>(low * (1.0 - at) + high * at), low, high));
        }
        for (int bits = 1; bits <= max_attribute_bits; ++bits) {
            const Mesh mesh = points_with(numbers);
            const CodedAttribute form = coded(mesh, bits);
            const double step = (double{form.maximum[0]} - form.minimum[0]) / ((1 << bits) - 1);
            const std::vector<float> back = rounded(mesh, bits);
            for (std::size_t i = 0; i < numbers.size(); ++i) {
                const double ulp = std::nextafter(std::abs(back[i]), std::numeric_limits<float>::infinity()) -
                                   double{std::abs(back[i])};
                // The rounding of the result to float32 comes on top.
                const double allowed = step / 2 * (1 + 1e-9) + (std::isfinite(ulp) ? ulp / 2 : 2e31 / 2);
                ASSERT_LE(std::abs(double{back[i]} - numbers[i]), allowed) << low << ' ' << high << ' ' << bits;
            }
        }
    }
}

TEST(CodedAttributes, AreThoseOfTheMeshThatAreWishedForInItsOrder) {
    const std::vector<AttributeWish> wishes{{"id", 3}, {"pressure", 8}, {"velocity", 0}, {"speed", 12}};
    const auto forms = coded_attributes(sample(), attribute_ranges(sample()), wishes);
    ASSERT_EQ(forms.size(), 3U);
    EXPECT_EQ(forms[0].name, "speed");
    EXPECT_EQ(forms[0].bits, 12);
    EXPECT_EQ(forms[0].coded_bytes(), 2U);
    EXPECT_EQ(forms[1].name, "velocity");
    EXPECT_EQ(forms[1].bits, 0);
    EXPECT_EQ(forms[1].coded_bytes(), 12U);
    EXPECT_EQ(forms[2].name, "id");
    EXPECT_EQ(forms[2].bits, 0) << "integers are exact";
    EXPECT_EQ(forms[2].coded_bytes(), 4U);
}

TEST(CodedAttributes, AreRefusedWithBitsThatNoneHas) {
    for (const int bits : {-1, 17}) {
        const AttributeWish wish{"speed", bits};
        EXPECT_NE(test::refusal([&] {
                      (void)coded_attributes(sample(), attribute_ranges(sample()), {&wish, 1});
                  }).find("'speed' is wished for with " + std::to_string(bits) + " bits, must be 1 to 16"),
                  std::string::npos);
    }
}

TEST(AttributeBricks, KeepEveryFormWithEveryNumberOfBits) {
    for (int bits = 0; bits <= max_attribute_bits; ++bits) {
        SCOPED_TRACE(bits);
        const auto wishes = test::wish_for_all(sample(), bits);
        const Mesh received = through_bricks(sample(), options_for(sample(), wishes));
        EXPECT_EQ(mesh_sha256(received), mesh_sha256(sample()));
        Mesh expected = sample();
        round_attributes(expected, wishes);
        expect_same_attributes(in_canonical_order(received), in_canonical_order(expected));
        if (bits == 0) expect_same_attributes(expected, sample());
    }
}

TEST(AttributeBricks, AreTheSameAtEverySpeedAndWithoutNormals) {
    const auto wishes = test::wish_for_all(sample(), 8);
    CodingOptions options = options_for(sample(), wishes);
    const Mesh expected = in_canonical_order(through_bricks(sample(), options));
    for (const int speed : {0, 4, 5, 7})
        expect_same_attributes(in_canonical_order(through_bricks(sample(), options_for(sample(), wishes, speed))),
                               expected);
    options.normal_bits = 0;
    expect_same_attributes(in_canonical_order(through_bricks(sample(), options)), expected);
}

TEST(AttributeBricks, KeepEveryBitOfFloatsAndIds) {
    Mesh mesh = sample();
    mesh.attributes.clear();
    std::mt19937 random(4);
    std::vector<float> floats;
    std::vector<std::uint32_t> ids;
    std::vector<std::int32_t> numbers;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        float any = test::float_of(static_cast<std::uint32_t>(random()));
        if (!std::isfinite(any)) any = -0.0F;
        floats.push_back(v % 7 == 0 ? smallest : any);
        ids.push_back(v % 5 == 0 ? 0xFFFFFFFFU : static_cast<std::uint32_t>(random()));
        numbers.push_back(v % 3 == 0 ? std::numeric_limits<std::int32_t>::min() : static_cast<std::int32_t>(random()));
    }
    mesh.attributes.push_back(test::attribute_of("floats", ElementType::float32, 1, floats));
    mesh.attributes.push_back(test::attribute_of("ids", ElementType::uint32, 1, ids));
    mesh.attributes.push_back(test::attribute_of("numbers", ElementType::int32, 1, numbers));
    const CodingOptions options = options_for(mesh, test::wish_for_all(mesh, 0));
    expect_same_attributes(in_canonical_order(through_bricks(mesh, options)), in_canonical_order(mesh));
}

TEST(AttributeBricks, AreHashedWithTheirAttributesAndTheirForms) {
    const auto wishes = test::wish_for_all(sample(), 8);
    const BrickContent content = brick_content(sample(), 0, options_for(sample(), wishes));
    EXPECT_EQ(content.hash(), brick_content(sample(), 0, options_for(sample(), wishes)).hash());
    EXPECT_NE(content.hash(), brick_content(sample(), 0).hash());
    const auto differs = [&](const auto& change) {
        BrickContent other = content;
        change(other);
        EXPECT_NE(other.hash(), content.hash());
    };
    differs([](BrickContent& c) { c.attributes.front().back() ^= std::byte{1}; });
    differs([](BrickContent& c) { std::swap(c.attributes[3], c.attributes[4]); });
    differs([](BrickContent& c) { c.attribute_forms[0].name = "spee"; });
    differs([](BrickContent& c) { c.attribute_forms[1].maximum[2] *= 2.0F; });
    differs([](BrickContent& c) { c.attribute_forms[1].minimum[0] -= 1.0F; });
    differs([](BrickContent& c) { c.attribute_forms[0].bits = 7; });
    // As a frame in which the water's speed alone has changed.
    Mesh faster = sample();
    faster.attributes[7].data.back() ^= std::byte{1};
    const auto last = faster.bricks.size() - 1;
    EXPECT_NE(brick_content(faster, last, options_for(faster, wishes)).hash(),
              brick_content(sample(), last, options_for(sample(), wishes)).hash());
}

TEST(AttributeBricks, AreNotMadeOfAttributesThatTheMeshLacks) {
    const CodingOptions options = options_for(sample(), test::wish_for_all(sample(), 8));
    const auto refused = [&](const auto& change) {
        CodingOptions other = options;
        change(other.attributes[1]);
        return test::refusal([&] { (void)brick_content(sample(), 0, other); });
    };
    const std::string none = "no attribute 'velocity'";
    EXPECT_NE(refused([](CodedAttribute& a) { a.name = "pressure"; }).find("no attribute 'pressure'"),
              std::string::npos);
    EXPECT_NE(refused([](CodedAttribute& a) { a.components = 4; }).find(none), std::string::npos);
    EXPECT_NE(refused([](CodedAttribute& a) { a.type = ElementType::uint32; }).find(none), std::string::npos);
    EXPECT_NE(refused([](CodedAttribute& a) { a.bits = 17; }).find("with 17 bits"), std::string::npos);
    EXPECT_NE(refused([](CodedAttribute& a) { a.bits = -1; }).find("with -1 bits"), std::string::npos);
}

TEST(AttributeBricks, AreRefusedUnlessTheyAreWhatWasAnnounced) {
    const CodingOptions options = options_for(sample(), test::wish_for_all(sample(), 8));
    const EncodedBrick brick = encode_brick(sample(), 0, options);
    const auto refused = [&](const auto& change) {
        std::vector<CodedAttribute> announced = options.attributes;
        change(announced);
        return test::refusal([&] { (void)decode_brick(brick, sample().offset_bits, announced); });
    };
    EXPECT_EQ(refused([](auto&) {}), "");
    EXPECT_NE(refused([](auto& all) { all.clear(); }).find("has 8 attributes, announced were 0"), std::string::npos);
    EXPECT_NE(refused([](auto& all) { all.pop_back(); }).find("announced were 7"), std::string::npos);
    EXPECT_NE(refused([](auto& all) { all.push_back(all[0]); }).find("announced were 9"), std::string::npos);
    const std::string lacks = "lacks the attribute 'velocity' as it was announced, with the unique id 17";
    EXPECT_NE(refused([](auto& all) { all[1].components = 4; }).find(lacks), std::string::npos);
    EXPECT_NE(refused([](auto& all) { all[1].bits = 9; }).find(lacks), std::string::npos);
    EXPECT_NE(refused([](auto& all) { all[1].bits = 0; }).find(lacks), std::string::npos);
    EXPECT_NE(refused([](auto& all) { all[7].type = ElementType::float32; }).find("lacks the attribute 'id'"),
              std::string::npos);
    EXPECT_NE(refused([](auto& all) {
                  all[1].type = ElementType::uint32;
              }).find("'velocity' is uint32 of 3 components, must be"),
              std::string::npos);
    EXPECT_NE(refused([](auto& all) { all[1].bits = 40; }).find("is to be coded with 40 bits"), std::string::npos);
    EXPECT_NE(refused([](auto& all) { all[0].bits = 2; }).find("in 2 bits"), std::string::npos);
    const EncodedBrick without = encode_brick(sample(), 0);
    EXPECT_NE(test::refusal([&] {
                  (void)decode_brick(without, sample().offset_bits, options.attributes);
              }).find("has 0 attributes, announced were 8"),
              std::string::npos);
}

TEST(AttributeBricks, AreRefusedWithFloatsThatAreNotFinite) {
    Mesh mesh = sample();
    std::vector<float> speeds = test::numbers_of<float>(mesh.attributes[0]);
    speeds[mesh.triangles[mesh.bricks[0].ranges[0].first][0]] = std::numeric_limits<float>::quiet_NaN();
    mesh.attributes[0] = test::attribute_of("speed", ElementType::float32, 1, speeds);
    CodingOptions options;
    options.attributes = {{.name = "speed", .type = ElementType::float32, .components = 1, .bits = 0}};
    bool found = false;
    for (std::size_t b = 0; b < mesh.bricks.size(); ++b)
        found = found || test::refusal([&] {
                             (void)decode_brick(encode_brick(mesh, b, options), mesh.offset_bits, options.attributes);
                         }).find("'speed' has a value that is not finite") != std::string::npos;
    EXPECT_TRUE(found);
}

TEST(AttributeBricks, AreRefusedOrDecodedToSomeMeshWhenDamaged) {
    const CodingOptions options = options_for(sample(), test::wish_for_all(sample(), 8));
    const EncodedBrick whole = encode_brick(sample(), sample().bricks.size() - 1, options);
    int refused = 0;
    for (const EncodedBrick& damaged : test::damaged(whole, 300))
        refused += test::refusal([&] {
                       const DecodedBrick decoded = decode_brick(damaged, sample().offset_bits, options.attributes);
                       ASSERT_EQ(decoded.attributes.size(), options.attributes.size());
                       for (const MeshAttribute& attribute : decoded.attributes)
                           ASSERT_EQ(attribute.data.size(), decoded.vertices.size() * attribute.element_bytes());
                   }).empty()
                       ? 0
                       : 1;
    EXPECT_GT(refused, 20);
}

TEST(AttributeBricks, AreNotWeldedToOnesOfOtherAttributes) {
    ASSERT_GT(sample().bricks.size(), 1U);
    const CodingOptions options = options_for(sample(), test::wish_for_all(sample(), 8));
    std::vector<DecodedBrick> bricks;
    for (const std::size_t b : {0U, 1U})
        bricks.push_back(decode_brick(encode_brick(sample(), b, options), sample().offset_bits, options.attributes));
    EXPECT_EQ(weld_bricks(bricks, 1.0, sample().offset_bits).attributes.size(), 8U);
    bricks[1].attributes[2].name = "other";
    EXPECT_NE(
        test::refusal([&] { (void)weld_bricks(bricks, 1.0, sample().offset_bits); }).find("have different attributes"),
        std::string::npos);
}

}  // namespace
}  // namespace meniscus
