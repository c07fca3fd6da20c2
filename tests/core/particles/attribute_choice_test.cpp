// Settings that name attributes, and frames without them: refused with the name, and nothing changes.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "meniscus/meniscus.hpp"
#include "support/attributes.hpp"
#include "support/particles.hpp"
#include "support/refusal.hpp"

namespace meniscus {
namespace {

Settings naming(std::vector<std::string> names) {
    Settings settings = test::default_settings();
    settings.attributes = std::move(names);
    return settings;
}

test::ParticlesWithArrays moving() {
    test::ParticlesWithArrays p;
    p.particles = test::splash(3, 4);
    p.add_floats("velocity", 3, [](std::size_t i, std::size_t c) { return static_cast<float>(i + c); });
    p.add<std::uint32_t>("id", ElementType::uint32, 1, [](std::size_t i, std::size_t) { return i; });
    p.add_floats("age", 1, [](std::size_t i, std::size_t) { return static_cast<float>(i); });
    return p;
}

TEST(AttributeChoice, NamesThatCannotBeAreRefused) {
    const auto refused = [](const Settings& settings) { return test::refusal([&] { validate(settings); }); };
    EXPECT_EQ(refused(naming({"velocity", "age_2"})), "");
    EXPECT_EQ(refused(naming({std::string(64, 'a')})), "");
    for (const std::string& name : {std::string(), std::string(65, 'a'), std::string("Velocity"), std::string("a b"),
                                    std::string("a\0b", 3), std::string("\xC3\xA4")})
        EXPECT_NE(refused(naming({name})).find("1 to 64 of the characters a-z, 0-9 and _"), std::string::npos) << name;
    EXPECT_NE(refused(naming({"position"})).find("'position' is what the surface is made from"), std::string::npos);
    EXPECT_NE(refused(naming({"level"})).find("'level' is what the surface is made from"), std::string::npos);
    EXPECT_NE(refused(naming({"age", "id", "age"})).find("'age' twice"), std::string::npos);
    std::vector<std::string> many;
    many.reserve(17);
    for (int i = 0; i < 17; ++i) many.push_back("a_" + std::to_string(i));
    EXPECT_NE(refused(naming(many)).find("17 attributes, at most 16"), std::string::npos);
    many.pop_back();
    EXPECT_EQ(refused(naming(many)), "");
    Settings both = naming({"age"});
    both.all_attributes = true;
    EXPECT_NE(refused(both).find("'age' among the attributes and ask for all"), std::string::npos);
    EXPECT_EQ(in_force(naming({"age"})).attributes, std::vector<std::string>{"age"});
}

TEST(AttributeChoice, FramesThatDoNotBringWhatIsNamedAreRefused) {
    struct Case {
        std::function<void(test::ParticlesWithArrays&)> change;
        const char* named;
    };
    const auto set_float = [](test::ParticlesWithArrays& p, std::size_t array, std::size_t at, float value) {
        std::memcpy(p.bytes[array].data() + 4 * at, &value, sizeof value);
    };
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const Case cases[] = {
        {[](auto& p) { p.names[0] = "speed"; }, "no array 'velocity', which the settings name"},
        {[](auto& p) { p.names[2] = "velocity"; }, "'velocity' comes twice"},
        {[](auto& p) {
             p.arrays[0].components = 1;
             p.arrays[0].type = ElementType::float32;
             p.bytes[0].resize(4 * p.particles.count());
         },
         "'velocity' is float32 of 1 component, must be as in the frames before: float32 of 3 components"},
        {[](auto& p) {
             p.arrays[0] = {{}, {}, ElementType::uint8, 12};
         },
         "'velocity' is uint8 of 12 components, an attribute must be float32 or uint8 of 1, 3 or 4"},
        {[](auto& p) {
             p.arrays[0] = {{}, {}, ElementType::int32, 3};
         },
         "'velocity' is int32 of 3 components"},
        {[](auto& p) { p.bytes[0].pop_back(); }, "array 'velocity' has"},
        {[&](auto& p) { set_float(p, 0, 3 * 7 + 2, nan); }, "particle 7 has a value of 'velocity' that is not finite"},
        {[&](auto& p) {
             set_float(p, 0, 3 * 9 + 1, -inf);
             set_float(p, 0, 3 * 11, inf);
         },
         "particle 9 has a value of 'velocity' that is not finite (component 1)"},
        {[&](auto& p) { set_float(p, 2, 5, -nan); }, "particle 5 has a value of 'age' that is not finite:"},
    };
    const test::ParticlesWithArrays good = moving();
    for (const bool all : {false, true}) {
        Settings settings = naming(all ? std::vector<std::string>{} : std::vector<std::string>{"velocity", "age"});
        settings.all_attributes = all;
        Reconstructor reconstructor(settings, {Backend::cpu, 1});
        Mesh mesh;
        test::ParticlesWithArrays p = good;
        reconstructor.reconstruct(p.frame(), mesh);
        const Mesh expected = mesh;
        for (const Case& c : cases) {
            p = good;
            c.change(p);
            const std::string message = test::refusal([&] { reconstructor.reconstruct(p.frame(), mesh); });
            if (!all || std::string_view(c.named).find("the settings name") == std::string_view::npos) {
                EXPECT_NE(message.find(c.named), std::string::npos) << "expected '" << c.named << "', got " << message;
            } else {
                EXPECT_NE(message.find("no array 'velocity', which frames before it brought"), std::string::npos);
            }
            reconstructor.emit_capped(3, mesh);
            EXPECT_TRUE(test::same_attributes(mesh, expected)) << "a refused frame changes nothing";
            const bool by_itself = std::string_view(c.named).find("frames before") == std::string_view::npos;
            if (by_itself && !all) {
                EXPECT_EQ(test::refusal([&] { validate(p.frame(), settings); }), message);
            }
        }
        p = good;
        reconstructor.reconstruct(p.frame(), mesh);
        EXPECT_TRUE(test::same_attributes(mesh, expected));
    }
}

TEST(AttributeChoice, WhatIsNotNamedIsPassedOver) {
    test::ParticlesWithArrays p = moving();
    Reconstructor reconstructor(naming({"id"}), {Backend::cpu, 1});
    Mesh mesh;
    reconstructor.reconstruct(p.frame(), mesh);
    // Twice, not finite, of another form than before: not refused, since no setting names them.
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(p.bytes[0].data(), &nan, sizeof nan);
    p.names[2] = "velocity";
    p.arrays[2].type = ElementType::int32;
    EXPECT_EQ(test::refusal([&] { reconstructor.reconstruct(p.frame(), mesh); }), "");
    ASSERT_EQ(mesh.attributes.size(), 1U);
    EXPECT_EQ(mesh.attributes[0].name, "id");
}

TEST(AttributeChoice, AllAreThoseOfTheFirstFrameThatBringsSome) {
    Settings settings = test::default_settings();
    settings.all_attributes = true;
    Reconstructor reconstructor(settings, {Backend::cpu, 1});
    Mesh mesh;
    reconstructor.reconstruct(ParticleFrame{}, mesh);
    EXPECT_TRUE(mesh.attributes.empty());
    test::ParticlesWithArrays p = moving();
    test::ParticlesWithArrays bad = p;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    bad.names.emplace_back("extra");
    bad.arrays.push_back({{}, {}, ElementType::float32, 1});
    bad.bytes.emplace_back(4 * p.particles.count());
    std::memcpy(bad.bytes[3].data(), &nan, sizeof nan);
    EXPECT_NE(test::refusal([&] { reconstructor.reconstruct(bad.frame(), mesh); }), "");
    reconstructor.reconstruct(p.frame(), mesh);
    ASSERT_EQ(mesh.attributes.size(), 3U) << "a refused frame fixes nothing";
    reconstructor.reconstruct(bad.frame(), mesh);
    ASSERT_EQ(mesh.attributes.size(), 3U) << "what comes later is passed over";
    EXPECT_FALSE(mesh.attributes[0].data.empty());
    reconstructor.reconstruct(ParticleFrame{}, mesh);
    ASSERT_EQ(mesh.attributes.size(), 3U);
    EXPECT_TRUE(mesh.attributes[0].data.empty()) << "a frame without particles may lack the arrays";
    EXPECT_NE(test::refusal([&] { reconstructor.reconstruct(p.particles.frame(), mesh); }).find("no array 'velocity'"),
              std::string::npos);
    reconstructor.reconstruct(p.frame(), mesh);
    EXPECT_EQ(mesh.attributes[1].data.size(), 4 * mesh.vertices.size());
}

}  // namespace
}  // namespace meniscus
