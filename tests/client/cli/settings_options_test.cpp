// The flags of the settings: a preset, what was given over it, and what is refused.
#include "cli/options/settings_options.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::cli {
namespace {

constexpr double radius = 0.25;

Settings parsed(const std::string& flags) {
    CLI::App app;
    SettingsOptions options;
    options.add_to(app);
    options.add_attribute_to(app);
    app.parse(flags);
    return options.build(radius);
}

std::string refusal(const std::string& flags) {
    try {
        parsed(flags);
    } catch (const InvalidInput& e) {
        return e.what();
    }
    return {};
}

TEST(SettingsOptions, WithoutFlagsAreTheLibrarysDefaults) {
    Settings defaults;
    defaults.particle_radius = radius;
    EXPECT_EQ(parsed(""), defaults);
}

TEST(SettingsOptions, OfAPresetAloneAreThoseOfTheLibrary) {
    for (const Preset named : choices<Preset>)
        EXPECT_EQ(parsed("--preset " + std::string(name_of(named))), preset(named, radius)) << name_of(named);
}

TEST(SettingsOptions, OverrideThePresetOneByOneInAnyOrder) {
    Settings expected = preset(Preset::paper, radius);
    expected.cell_size = 1.0;
    expected.smoothing_length = 1.5;
    EXPECT_EQ(parsed("--preset paper --cell-size 1 --smoothing-length 1.5"), expected);
    EXPECT_EQ(parsed("--cell-size 1 --smoothing-length 1.5 --preset paper"), expected);

    expected = preset(Preset::splashsurf, radius);
    expected.mode = Mode::adaptive;
    expected.normals = false;
    expected.domain = Box{{0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}};
    EXPECT_EQ(parsed("--preset splashsurf --mode adaptive --no-normals --domain 0 0 0 1 2 3"), expected);

    expected = preset(Preset::smooth, radius);
    expected.field = Field::smooth;
    expected.smoothness = 7;
    expected.spray = Spray::discard;
    expected.iso = 0.5;
    expected.criterion = CurvatureCriterion{0.3};
    EXPECT_EQ(parsed("--field smooth --smoothness 7 --spray discard --iso 0.5 --tolerance 0.3"), expected);
}

TEST(SettingsOptions, TheLastOfTwoFlagsOfNormalsCounts) {
    EXPECT_TRUE(parsed("--no-normals --no-normals --normals").normals);
    EXPECT_FALSE(parsed("--normals --normals --no-normals").normals);
    EXPECT_TRUE(parsed("--preset paper --normals").normals);
}

TEST(SettingsOptions, AnEmptyNumberIsAsNotGiven) {
    Settings defaults;
    defaults.particle_radius = radius;
    for (const char* flag : {"--cell-size", "--iso", "--tolerance", "--smoothness", "--count-threshold"}) {
        CLI::App app;
        SettingsOptions options;
        options.add_to(app);
        app.parse(std::vector<std::string>{"", flag});  // the last argument comes first
        EXPECT_EQ(options.build(radius), defaults) << flag;
    }
}

TEST(SettingsOptions, MayMoveOnAfterTheirCommandHasGone) {
    SettingsOptions options;
    {
        CLI::App app;
        options.add_to(app);
        app.parse("--no-normals --cell-size 1");
    }
    const SettingsOptions moved = std::move(options);
    const Settings settings = moved.build(radius);
    EXPECT_FALSE(settings.normals);
    EXPECT_EQ(settings.cell_size, 1.0);
}

TEST(SettingsOptions, NameAttributesOneByOneOrAllOfThem) {
    Settings expected;
    expected.particle_radius = radius;
    expected.attributes = {"velocity", "age"};
    EXPECT_EQ(parsed("--attribute velocity --attribute age"), expected);
    expected.attributes.clear();
    expected.all_attributes = true;
    EXPECT_EQ(parsed("--attribute all"), expected);
    EXPECT_EQ(refusal("--attribute all --attribute age"),
              "--attribute all takes every array: leave the other names out");
}

TEST(SettingsOptions, KeepThePresetsParametersOfAChoiceThatIsMadeOnceMore) {
    EXPECT_EQ(parsed("--preset paper --criterion count --edge-points bisect"), preset(Preset::paper, radius));
    Settings expected = preset(Preset::paper, radius);
    expected.criterion = CountCriterion{3};
    expected.edge_points = Bisection{6};
    EXPECT_EQ(parsed("--preset paper --count-threshold 3 --bisection-steps 6"), expected);
    expected.criterion = CurvatureCriterion{0.2};
    expected.edge_points = Interpolation{};
    EXPECT_EQ(parsed("--preset paper --criterion curvature --tolerance 0.2 --edge-points interpolate"), expected);
}

TEST(SettingsOptions, RefuseWhatBelongsToAnotherFieldThanThePresets) {
    const std::string no_smoothing_length =
        "the smoothing length is 2, but the field is smooth, which has none: leave it out and use --smoothness, or "
        "take "
        "--field color";
    EXPECT_EQ(refusal("--smoothing-length 2"), no_smoothing_length);
    EXPECT_EQ(refusal("--field smooth --smoothing-length 2"), no_smoothing_length);
    EXPECT_EQ(refusal("--preset paper --field smooth --smoothing-length 2"), no_smoothing_length);
    EXPECT_EQ(refusal("--field color --smoothing-length 2"), "");
    EXPECT_EQ(
        refusal("--preset splashsurf --smoothness 6"),
        "the smoothness is 6, but the field is color, which has none: leave it out and use --smoothing-length, or "
        "take --field smooth");
    EXPECT_EQ(refusal("--preset paper --spray points"),
              "spray is points, but the field is density, which does not tell spray from water: take --spray keep or "
              "--field smooth");
    EXPECT_EQ(refusal("--preset paper --tolerance 0.1"),
              "--tolerance needs --criterion curvature, but --criterion is count");
    EXPECT_EQ(refusal("--field smooth --smoothness 8"), "the smoothness is 8, must be 5 to 7");
    EXPECT_THROW(parsed("--preset foam"), CLI::ParseError);
    EXPECT_THROW(parsed("--spray away"), CLI::ParseError);
    EXPECT_THROW(parsed("--smoothness -6"), CLI::ParseError);
}

}  // namespace
}  // namespace meniscus::cli
