#include "sessions/limits/frame_rate.hpp"

#include <gtest/gtest.h>

namespace meniscus::server {
namespace {

using std::chrono::milliseconds;

const FrameRate::Clock::time_point start = FrameRate::Clock::time_point{} + std::chrono::hours(1);

TEST(FrameRate, TakesASecondsFramesAndNotOneMore) {
    FrameRate rate(10);
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(rate.take(start)) << i;
    EXPECT_FALSE(rate.take(start));
}

TEST(FrameRate, TakesFramesAtTheLimitForEver) {
    FrameRate rate(10);
    for (int i = 0; i < 10; ++i) rate.take(start);
    for (int i = 1; i < 100; ++i) {
        EXPECT_TRUE(rate.take(start + i * milliseconds(101))) << i;
        EXPECT_FALSE(rate.take(start + i * milliseconds(101))) << i;
    }
}

TEST(FrameRate, SavesNoMoreThanASecondsFrames) {
    FrameRate rate(3);
    rate.take(start);
    int taken = 0;
    while (rate.take(start + std::chrono::hours(5))) ++taken;
    EXPECT_EQ(taken, 3);
}

TEST(FrameRate, IsUnlimitedAtZero) {
    FrameRate rate(0);
    for (int i = 0; i < 1000; ++i) EXPECT_TRUE(rate.take(start));
}

}  // namespace
}  // namespace meniscus::server
