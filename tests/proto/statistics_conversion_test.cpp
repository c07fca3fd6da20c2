// Statistics on the wire.
#include "conversion/statistics_conversion.hpp"

#include <gtest/gtest.h>

namespace meniscus::conversion {
namespace {

TEST(StatisticsConversion, KeepsVolumesAndSpray) {
    Statistics statistics;
    statistics.particles = 9;
    statistics.spray_particles = 4;
    statistics.volume = 0.1;
    statistics.particle_volume = 1e-12;
    v1::FrameStatistics wire;
    to_wire(statistics, wire);
    const Statistics back = from_wire(wire);
    EXPECT_EQ(back.particles, 9U);
    EXPECT_EQ(back.spray_particles, 4U);
    EXPECT_EQ(back.volume, 0.1);
    EXPECT_EQ(back.particle_volume, 1e-12);
}

TEST(StatisticsConversion, KeepsWarnings) {
    Statistics statistics;
    for (const WarningCode code : choices<WarningCode>)
        statistics.warnings.push_back({code, 1.0 / 3, 1e-9, "about " + std::string(name_of(code)) + ": 3 µm"});
    v1::FrameStatistics wire;
    to_wire(statistics, wire);
    EXPECT_EQ(from_wire(wire).warnings, statistics.warnings);
}

TEST(StatisticsConversion, BoundsTheWarningsOfAHostileServerAndMakesThemPrintableLines) {
    v1::FrameStatistics wire;
    for (int i = 0; i < 1000; ++i) wire.add_warnings()->set_text(std::string(100'000, 'x'));
    wire.mutable_warnings(0)->set_text(
        "\x1b[2Jred\r\nalert\x07\xc2\x9b"
        "31m \xc3\xa9");
    wire.mutable_warnings(0)->set_code(static_cast<v1::WarningCode>(77));
    const Statistics taken = from_wire(wire);
    ASSERT_EQ(taken.warnings.size(), max_warnings);
    EXPECT_EQ(taken.warnings[0].code, WarningCode::unknown);
    EXPECT_EQ(taken.warnings[0].text, "\\u{001b}[2Jred\\u{000d}\\u{000a}alert\\u{0007}\\u{009b}31m \xc3\xa9");
    EXPECT_EQ(taken.warnings[1].text, std::string(max_warning_characters, 'x') + "...");
}

}  // namespace
}  // namespace meniscus::conversion
