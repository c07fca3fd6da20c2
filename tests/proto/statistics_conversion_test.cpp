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

}  // namespace
}  // namespace meniscus::conversion
