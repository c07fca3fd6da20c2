#include "sessions/limits/upload_pace.hpp"

#include <gtest/gtest.h>

namespace meniscus::server {
namespace {

using std::chrono::seconds;

struct Pace : testing::Test {
    bool too_slow(int second) { return pace.too_slow(least, start + seconds(second)).has_value(); }
    /// Asked every second, as a server asks. 0: not up to `last`.
    int too_slow_at(int first, int last) {
        for (int second = first; second <= last; ++second)
            if (too_slow(second)) return second;
        return 0;
    }

    const LeastPace least{.time = seconds(10), .bytes_per_second = 100};
    const UploadPace::Clock::time_point start{};
    UploadPace pace;
};

TEST_F(Pace, LetsAFrameTakeTheTimeThatItHas) {
    EXPECT_FALSE(too_slow(1000)) << "there is none";
    pace.begin(7, 5000, start);
    EXPECT_EQ(too_slow_at(0, 100), 10);
    pace.begin(8, 5000, start + seconds(15));
    EXPECT_EQ(too_slow_at(15, 24), 0);
    pace.end();
    EXPECT_FALSE(too_slow(1000));
    EXPECT_FALSE(UploadPace().too_slow({}, start + seconds(1000))) << "no limit";
}

TEST_F(Pace, EndsAFrameAsSoonAsItsTimeIsUpWhereThereIsNoRate) {
    pace.begin(7, 5000, start);
    pace.arrived(4999);
    const LeastPace none{.time = seconds(10), .bytes_per_second = 0};
    EXPECT_FALSE(pace.too_slow(none, start + seconds(9)));
    EXPECT_TRUE(pace.too_slow(none, start + seconds(10)));
}

TEST_F(Pace, LetsAFrameTakeLongerThatComesFastEnough) {
    pace.begin(7, 50'000, start);
    for (int second = 1; second < 100; ++second) {
        // In bursts: a pause of a connection is shorter than five seconds.
        if (second % 3 == 0) pace.arrived(600);
        if (second % 5 == 0) {
            EXPECT_FALSE(too_slow(second)) << second;
        }
    }
    EXPECT_NE(too_slow_at(100, 110), 0) << "nothing comes any more";
}

TEST_F(Pace, TakesWhatCameQuicklyForNoCreditForAStandstill) {
    pace.begin(7, 50'000, start);
    pace.arrived(49'999);
    EXPECT_EQ(too_slow_at(1, 100), 10);
    pace.begin(8, 50'000, start);
    pace.arrived(50'000);
    EXPECT_EQ(too_slow_at(1, 100), 10) << "its end is missing";
}

TEST_F(Pace, DoesNotCountTheTimeThatAFrameWaitsForTheServer) {
    pace.begin(7, 5000, start);
    pace.pause(start + seconds(4));
    EXPECT_TRUE(pace.paused());
    EXPECT_FALSE(too_slow(1000));
    pace.resume(start + seconds(1000));
    EXPECT_EQ(too_slow_at(1000, 1005), 0);
    const auto slow = pace.too_slow(least, start + seconds(1006));
    ASSERT_TRUE(slow);
    EXPECT_EQ(slow->index, 7U);
    EXPECT_EQ(slow->announced, 5000U);
    EXPECT_EQ(slow->time.count(), 10.0);
}

}  // namespace
}  // namespace meniscus::server
