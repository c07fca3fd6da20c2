// libcatalyst-meniscus.so where the server is away.
#include <gtest/gtest.h>

#include <chrono>

#include "catalyst_fixture.hpp"

namespace meniscus::test {
namespace {

/// Its server has gone when the simulation starts.
class CatalystAway : public Catalyst {
protected:
    CatalystAway() {
        process_.signal(SIGTERM);
        process_.exit_code();
        testing::internal::CaptureStderr();
    }
    int give() { return execute_frame(particles_, step_++); }
    void expect_that_frames_are_left_out() {
        for (int i = 0; i < 3; ++i) EXPECT_EQ(give(), catalyst_status_ok);
        EXPECT_EQ(results().left_out, 3);
        EXPECT_EQ(results().sent, 0);
    }

    const Particles particles_ = splash(1, 4);
    std::int64_t step_ = 0;
};

TEST_F(CatalystAway, StopsNothingAndIsSaidOnce) {
    start();
    expect_that_frames_are_left_out();
    std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(times(said, "frames are left out until"), 1U) << said;

    const auto goes_on = [&] {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        const std::int64_t before = results().sent;
        while (results().sent == before && std::chrono::steady_clock::now() < end)
            if (give() != catalyst_status_ok) return false;
        return results().sent > before;
    };
    testing::internal::CaptureStderr();
    for (int i = 0; i < 2; ++i) {
        server::test::Process back({"--listen", address_, "--threads", "2"});
        EXPECT_EQ(back.address(), address_);
        ASSERT_TRUE(goes_on());
        const CWatcher watcher = watch_on(address_);
        EXPECT_EQ(sha256_of(next(watcher, static_cast<std::uint64_t>(step_ - 1))), expected(particles_));
    }
    EXPECT_EQ(finalize(), catalyst_status_ok);
    said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(times(said, "frames go to session"), 2U) << said;
}

TEST_F(CatalystAway, IsAskedForAgainBySurfacesToo) {
    start("reconstruct-ranks=all threads=1");
    expect_that_frames_are_left_out();

    // What a frame lacks is told two frames later.
    const auto goes_on = [&] {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        std::int64_t left_out = 0;
        do {
            left_out = results().left_out;
            for (int i = 0; i < 4; ++i)
                if (give() != catalyst_status_ok) return false;
        } while (results().left_out != left_out && std::chrono::steady_clock::now() < end);
        return results().left_out == left_out;
    };
    for (int i = 0; i < 2; ++i) {
        server::test::Process back({"--listen", address_, "--threads", "2"});
        EXPECT_EQ(back.address(), address_);
        ASSERT_TRUE(goes_on());
        const CWatcher watcher = watch_on(address_);
        CFrame frame;
        ASSERT_EQ(meniscus_watcher_next(watcher.get(), patience, frame.out()), MENISCUS_OK) << meniscus_error_message();
        EXPECT_EQ(sha256_of(frame), expected(particles_));
    }
    EXPECT_EQ(finalize(), catalyst_status_ok);
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(times(said, "frames are left out until the server is there"), 1U) << said;
    EXPECT_EQ(times(said, "frames are left out until session"), 1U) << said;
    EXPECT_EQ(times(said, "surfaces of the ranks go to session"), 2U) << said;
}

}  // namespace
}  // namespace meniscus::test
