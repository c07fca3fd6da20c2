// The memory that frames arrive in, for a device that fetches them by itself.
#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>

#include "sessions/input_frame.hpp"
#include "simulator_player.hpp"

namespace meniscus::server {
namespace {

/// Keeps account of what is pinned.
class CountedPinning final : public PagePinning {
public:
    void pin(void* begin, std::size_t bytes) noexcept override {
        const std::lock_guard lock(mutex_);
        EXPECT_TRUE(pinned_.emplace(begin, bytes).second);
        ++calls_;
    }
    void unpin(void* begin) noexcept override {
        const std::lock_guard lock(mutex_);
        EXPECT_EQ(pinned_.erase(begin), 1U);
    }
    std::size_t now() const {
        const std::lock_guard lock(mutex_);
        return pinned_.size();
    }
    int calls() const {
        const std::lock_guard lock(mutex_);
        return calls_;
    }

private:
    mutable std::mutex mutex_;
    std::map<void*, std::size_t> pinned_;
    int calls_ = 0;
};

struct PinnedFrames : testing::Test {
    const std::shared_ptr<CountedPinning> pinning = std::make_shared<CountedPinning>();
};

TEST_F(PinnedFrames, ABufferIsPinnedOnceForAllFramesThatItHoldsAndNotByAnAnnouncement) {
    InputFrame input(std::make_shared<MemoryAccount>(), std::make_shared<BytesInFlight>(),
                     std::make_shared<SessionInFlight>(), nullptr, pinning);
    input.allocate(100'000);
    EXPECT_EQ(pinning->now(), 0U);
    for (int frame = 0; frame < 3; ++frame) {
        input.allocate(100'000);
        input.pin();
        input.land();
    }
    EXPECT_EQ(pinning->calls(), 1);
    input.allocate(200'000);
    EXPECT_EQ(pinning->now(), 0U) << "the memory has gone";
    input.pin();
    EXPECT_EQ(pinning->now(), 1U);
    input.free_memory();
    EXPECT_EQ(pinning->now(), 0U);
    input.allocate(1000);
    input.pin();
    EXPECT_EQ(pinning->now(), 0U) << "its page may be others' too";
}

TEST_F(PinnedFrames, AFrameThatIsKeptIsNotPinnedAnyMore) {
    const auto account = std::make_shared<MemoryAccount>();
    InputFrame kept(account);
    {
        InputFrame input(account, std::make_shared<BytesInFlight>(), std::make_shared<SessionInFlight>(), nullptr,
                         pinning);
        input.allocate(100'000);
        input.pin();
        kept.take_from(input);
        EXPECT_EQ(pinning->now(), 0U);
        input.allocate(100'000);
        input.pin();
    }
    EXPECT_EQ(pinning->now(), 0U);
    EXPECT_EQ(kept.bytes.size(), 100'000U);
}

TEST_F(PinnedFrames, ASessionPinsItsBuffersAndGivesThemBack) {
    const test::Particles particles = test::wave(24, 0.0);
    ASSERT_GE(particles.positions.size() * sizeof(float), PagePinning::least_bytes);
    {
        Session session({.id = test::id}, test::settings(), {}, {.reconstruct = test::reconstruct_on_the_cpu()},
                        {.workers = std::make_shared<WorkerPool>(1), .pinning = pinning});
        test::Simulator simulator(session, {});
        for (std::uint64_t i = 0; i < 6; ++i) simulator.send(i, particles);
        simulator.end();
        EXPECT_EQ(simulator.receive_all().size(), 6U);
        EXPECT_GE(pinning->calls(), 1);
        EXPECT_LE(pinning->calls(), 2) << "as many as slots";
    }
    EXPECT_EQ(pinning->now(), 0U);
}

}  // namespace
}  // namespace meniscus::server
