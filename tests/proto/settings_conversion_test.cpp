// Settings on the wire: what is sent, what is understood, what is refused.
#include "conversion/settings_conversion.hpp"

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <string>

#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::conversion {
namespace {

Settings of_field(Field field) {
    Settings settings;
    settings.particle_radius = 0.25;
    settings.field = field;
    return settings;
}

v1::Settings wire_of(v1::Field field) {
    v1::Settings wire;
    wire.set_particle_radius(0.25);
    wire.set_field(field);
    return wire;
}

/// The line of the refusal, as a server would answer it; empty if there is none.
std::string refusal(const v1::Settings& wire) {
    try {
        validate(from_wire(wire));
    } catch (const InvalidInput& e) {
        return e.what();
    }
    return {};
}

TEST(SettingsConversion, KeepsTheSettingsOfEachField) {
    for (const Field field : choices<Field>) {
        Settings settings = of_field(field);
        if (field == Field::smooth) {
            settings.smoothness = 7;
            settings.spray = Spray::points;
        } else {
            settings.smoothing_length = 1.75;
        }
        settings.criterion = CurvatureCriterion{0.3};
        EXPECT_EQ(from_wire(to_wire(settings)), settings) << name_of(field);
    }
}

TEST(SettingsConversion, KeepsEachWayWithSpray) {
    for (const Spray spray : choices<Spray>) {
        Settings settings = of_field(Field::smooth);
        settings.spray = spray;
        EXPECT_EQ(from_wire(to_wire(settings)).spray, spray) << name_of(spray);
    }
}

TEST(SettingsConversion, KeepsTheNamesOfAttributesInTheirOrderOrThatTheyAreAll) {
    Settings settings = of_field(Field::smooth);
    settings.attributes = {"velocity", "age"};
    EXPECT_EQ(from_wire(to_wire(settings)).attributes, settings.attributes);
    EXPECT_NE(from_wire(to_wire(settings)), in_force(of_field(Field::smooth)));
    settings.attributes.clear();
    settings.all_attributes = true;
    EXPECT_TRUE(from_wire(to_wire(settings)).all_attributes);
}

TEST(SettingsConversion, WritesTheDefaultsOfTheFieldOutAndNothingOfOtherFields) {
    for (const Field field : choices<Field>) {
        SCOPED_TRACE(name_of(field));
        const Settings settings = of_field(field);
        const v1::Settings wire = to_wire(settings);
        EXPECT_EQ(wire.has_smoothness(), field == Field::smooth);
        EXPECT_EQ(wire.has_smoothing_length(), field != Field::smooth);
        EXPECT_EQ(wire.smoothness(), field == Field::smooth ? smoothness(settings) : 0U);
        EXPECT_EQ(wire.smoothing_length(), field == Field::smooth ? 0.0 : smoothing_length(settings));
        EXPECT_EQ(wire.curvature().tolerance(), tolerance(settings));
        EXPECT_EQ(wire.spray(), v1::SPRAY_UNSPECIFIED);
        EXPECT_EQ(refusal(wire), "");
    }
}

TEST(SettingsConversion, TakesAFieldThatIsNotSetForTheSmoothOne) {
    v1::Settings wire;
    wire.set_particle_radius(0.25);
    EXPECT_EQ(from_wire(wire), from_wire(wire_of(v1::FIELD_SMOOTH)));
    Settings defaults;
    defaults.particle_radius = 0.25;
    defaults.criterion = CurvatureCriterion{0.15};
    EXPECT_EQ(from_wire(wire), in_force(defaults));
    wire.set_smoothing_length(2.0);
    EXPECT_NE(refusal(wire).find("the smoothing length is 2, but the field is smooth"), std::string::npos);
}

TEST(SettingsConversion, MakesSettingsEqualWhetherOrNotADefaultIsNamed) {
    for (const v1::Field field : {v1::FIELD_COLOR, v1::FIELD_DENSITY, v1::FIELD_SMOOTH}) {
        v1::Settings wire = wire_of(field);
        wire.mutable_curvature()->set_tolerance(tolerance(Settings{}));
        const Settings unnamed = from_wire(wire);
        EXPECT_EQ(from_wire(to_wire(unnamed)), unnamed);
        EXPECT_EQ(in_force(of_field(unnamed.field)), unnamed) << name_of(unnamed.field);
    }
}

TEST(SettingsConversion, KeepsWhatAnAbsentToleranceMeans) {
    for (const v1::Field field : {v1::FIELD_COLOR, v1::FIELD_DENSITY, v1::FIELD_SMOOTH}) {
        v1::Settings wire = wire_of(field);
        EXPECT_EQ(tolerance(from_wire(wire)), 0.15);
        wire.mutable_curvature();
        EXPECT_EQ(tolerance(from_wire(wire)), 0.15);
    }
    EXPECT_EQ(tolerance(from_wire(to_wire(of_field(Field::smooth)))), tolerance(Settings{}));
}

TEST(SettingsConversion, SendsWhatWasGivenForAnotherFieldForTheReceiverToRefuse) {
    Settings settings = of_field(Field::smooth);
    settings.smoothing_length = 2.0;
    EXPECT_NE(refusal(to_wire(settings)), "");
    settings = of_field(Field::color);
    settings.smoothness = 6;
    EXPECT_NE(refusal(to_wire(settings)), "");
    settings = of_field(Field::color);
    settings.spray = Spray::discard;
    EXPECT_NE(refusal(to_wire(settings)), "");
}

TEST(SettingsConversion, RefusesASmoothingLengthOfTheSmoothFieldWithALineThatSaysWhatToDo) {
    v1::Settings wire = wire_of(v1::FIELD_SMOOTH);
    wire.set_smoothing_length(2.0);
    EXPECT_EQ(
        refusal(wire),
        "the smoothing length is 2, but the field is smooth, which has none: leave it out and use --smoothness, or "
        "take --field color");
}

TEST(SettingsConversion, RefusesSmoothnessAndSprayOfTheOtherFields) {
    for (const auto& [field, name] : {std::pair{v1::FIELD_COLOR, "color"}, {v1::FIELD_DENSITY, "density"}}) {
        v1::Settings wire = wire_of(field);
        wire.set_smoothness(6);
        EXPECT_EQ(refusal(wire),
                  std::string("the smoothness is 6, but the field is ") + name +
                      ", which has none: leave it out and use --smoothing-length, or take --field smooth");
        wire = wire_of(field);
        wire.set_spray(v1::SPRAY_DISCARD);
        EXPECT_EQ(refusal(wire), std::string("spray is discard, but the field is ") + name +
                                     ", which does not tell spray from water: take --spray keep or --field smooth");
        wire.set_spray(v1::SPRAY_KEEP);
        EXPECT_EQ(refusal(wire), "");
    }
}

TEST(SettingsConversion, RefusesASmoothnessOutOfRangeAndASprayThatItDoesNotKnow) {
    v1::Settings wire = wire_of(v1::FIELD_SMOOTH);
    for (const std::uint32_t smoothness : {0U, 4U, 8U, 4294967295U}) {
        wire.set_smoothness(smoothness);
        EXPECT_EQ(refusal(wire), "the smoothness is " + std::to_string(smoothness) + ", must be 5 to 7");
    }
    for (const std::uint32_t smoothness : {5U, 6U, 7U}) {
        wire.set_smoothness(smoothness);
        EXPECT_EQ(refusal(wire), "") << smoothness;
    }
    wire.set_spray(static_cast<v1::Spray>(9));
    EXPECT_EQ(refusal(wire), "settings.spray has the value 9, which this version does not know");
}

/// Settings of a client older than the smooth field, as it sent them: everything was spelled out.
TEST(SettingsConversion, UnderstandsClientsOlderThanTheSmoothField) {
    v1::Settings wire = wire_of(v1::FIELD_COLOR);
    wire.set_smoothing_length(2.0);
    wire.set_cell_size(0.5);
    wire.set_iso(0.6);
    wire.set_mode(v1::MODE_ADAPTIVE);
    wire.mutable_curvature()->set_tolerance(0.15);
    wire.mutable_interpolate();
    wire.set_normals(true);
    EXPECT_EQ(from_wire(wire), from_wire(wire_of(v1::FIELD_COLOR)));
    EXPECT_EQ(to_wire(from_wire(wire)).SerializeAsString(), wire.SerializeAsString());
}

/// The table in proto/README.md, whose cells are protobuf's text format.
std::map<std::string, std::string> documented_presets() {
    std::ifstream file(MENISCUS_PROTO_README);
    std::map<std::string, std::string> presets;
    const std::regex row(R"(\| `(\w+)` \|(?: `(.*)`)? *\|.*)");
    bool in_section = false;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with('#')) in_section = line.find("Presets") != std::string::npos;
        std::smatch match;
        if (in_section && std::regex_match(line, match, row)) presets[match[1]] = match[2];
    }
    return presets;
}

TEST(SettingsConversion, TheDocumentsPresetsAreTheLibrarys) {
    const auto documented = documented_presets();
    EXPECT_EQ(documented.size(), choices<Preset>.size());
    for (const Preset named : choices<Preset>) {
        const std::string name(name_of(named));
        ASSERT_TRUE(documented.contains(name)) << name;
        v1::Settings wire;
        ASSERT_TRUE(google::protobuf::TextFormat::ParseFromString(documented.at(name), &wire)) << name;
        wire.set_particle_radius(0.25);
        EXPECT_EQ(from_wire(wire), from_wire(to_wire(preset(named, 0.25)))) << name;
    }
}

}  // namespace
}  // namespace meniscus::conversion
