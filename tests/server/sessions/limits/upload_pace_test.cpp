#include "sessions/limits/upload_pace.hpp"

#include <gtest/gtest.h>

namespace meniscus::server {
namespace {

using std::chrono::seconds;

struct Pace : testing::Test {
    bool too_slow(int second) const { return pace.too_slow(least, start + seconds(second)).has_value(); }

    const LeastPace least{.time = seconds(10), .bytes_per_second = 100};
    const UploadPace::Clock::time_point start{};
    UploadPace pace;
};

TEST_F(Pace, LetsAFrameTakeTheTimeThatItHas) {
    EXPECT_FALSE(too_slow(1000)) << "there is none";
    pace.begin(7, 5000, start);
    EXPECT_FALSE(too_slow(9));
    EXPECT_TRUE(too_slow(10));
    pace.end();
    EXPECT_FALSE(too_slow(1000));
    EXPECT_FALSE(UploadPace().too_slow({}, start + seconds(1000))) << "no limit";
}

TEST_F(Pace, LetsAFrameTakeLongerThatComesFastEnough) {
    pace.begin(7, 5000, start);
    pace.arrived(1000);
    EXPECT_FALSE(too_slow(19));
    EXPECT_TRUE(too_slow(20));
    pace.arrived(4000);
    EXPECT_FALSE(too_slow(59));
    EXPECT_TRUE(too_slow(60)) << "its end is missing";
}

TEST_F(Pace, DoesNotCountTheTimeThatAFrameWaitsForTheServer) {
    pace.begin(7, 5000, start);
    pace.pause(start + seconds(4));
    EXPECT_TRUE(pace.paused());
    EXPECT_FALSE(too_slow(1000));
    pace.resume(start + seconds(1000));
    EXPECT_FALSE(too_slow(1005));
    const auto slow = pace.too_slow(least, start + seconds(1006));
    ASSERT_TRUE(slow);
    EXPECT_EQ(slow->index, 7U);
    EXPECT_EQ(slow->announced, 5000U);
    EXPECT_EQ(slow->time.count(), 10.0);
}

}  // namespace
}  // namespace meniscus::server
