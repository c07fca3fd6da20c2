// The memory that frames arrive in, for a device that fetches them by itself.
#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <semaphore>
#include <set>

#include "sessions/intake/input_frame.hpp"
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

/// A device to which frames are sent, and which records what becomes of them.
class Receiver final : public FrameUpload::Sender {
public:
    void withdraw(std::uint64_t number) noexcept override {
        const std::lock_guard lock(mutex_);
        ahead_.erase(number);
        taken_.erase(number);
    }
    /// Takes one at a time beside those that are worked at, as a GPU does: returns 0 for another.
    std::uint64_t send(const void* first) {
        const std::lock_guard lock(mutex_);
        if (one_at_a_time && ahead_.size() > taken_.size()) return 0;
        ahead_.emplace(++sent_, first);
        return sent_;
    }
    /// The frame's first byte, of one that is ahead still.
    const void* take(std::uint64_t number) {
        const std::lock_guard lock(mutex_);
        const auto found = ahead_.find(number);
        if (found == ahead_.end()) return nullptr;
        taken_.insert(number);
        return found->second;
    }
    std::uint64_t sent() const {
        const std::lock_guard lock(mutex_);
        return sent_;
    }
    std::size_t ahead() const {
        const std::lock_guard lock(mutex_);
        return ahead_.size();
    }

    std::atomic<bool> one_at_a_time{false};

private:
    mutable std::mutex mutex_;
    std::map<std::uint64_t, const void*> ahead_;
    std::set<std::uint64_t> taken_;  ///< of those, by their reconstructions
    std::uint64_t sent_ = 0;
};

struct FramesSentAhead : testing::Test {
    ~FramesSentAhead() override { gate.release(1000); }

    std::function<FrameUpload(const ParticleFrame&)> send_ahead() {
        return [receiver = receiver](const ParticleFrame& frame) {
            const std::uint64_t number = receiver->send(frame.positions.data());
            return number != 0 ? FrameUpload(receiver, number) : FrameUpload();
        };
    }

    const std::shared_ptr<Receiver> receiver = std::make_shared<Receiver>();
    std::counting_semaphore<> gate{0};  ///< one reconstruction for each
    std::atomic<int> begun{0};
    std::atomic<int> as_sent{0};  ///< frames that were ahead when their reconstruction began
    Session session{{.id = test::id},
                    test::settings(),
                    {},
                    {.reconstruct =
                         [this, cpu = test::reconstruct_on_the_cpu()](const ParticleFrame& frame, Mesh& mesh) {
                             const void* const sent = receiver->take(frame.sent->number_of(receiver.get()));
                             if (sent == frame.positions.data()) ++as_sent;
                             ++begun;
                             begun.notify_all();
                             gate.acquire();
                             return cpu(frame, mesh);
                         },
                     .send_ahead = send_ahead()},
                    {.workers = std::make_shared<WorkerPool>(1)}};
    const test::Particles particles = test::wave(4, 0.0);
};

TEST_F(FramesSentAhead, EachIsSentAsSoonAsItHasArrivedAndItsReconstructionIsToldOfIt) {
    test::Simulator simulator(session, {});
    simulator.send(0, particles);
    begun.wait(0);
    simulator.send(1, particles);
    EXPECT_EQ(receiver->sent(), 2U) << "while the first is worked at";
    gate.release(2);
    simulator.end();
    EXPECT_EQ(simulator.receive_all().size(), 2U);
    EXPECT_EQ(as_sent, 2);
    EXPECT_EQ(receiver->ahead(), 0U);
}

TEST_F(FramesSentAhead, AFrameThatIsReplacedIsWithdrawnBeforeItsMemoryIsWrittenAgain) {
    receiver->one_at_a_time = true;
    test::Simulator simulator(session, {.policy = UploadPolicy::latest});
    simulator.send(0, particles);
    begun.wait(0);
    for (std::uint64_t i = 1; i < 5; ++i) {
        simulator.send(i, particles);
        EXPECT_EQ(receiver->ahead(), 2U) << "the one that is worked at, and the one that waits";
    }
    gate.release(2);
    simulator.end();
    EXPECT_EQ(simulator.receive_story().size(), 5U);
    EXPECT_EQ(as_sent, 2);
    EXPECT_EQ(receiver->ahead(), 0U);
}

TEST_F(FramesSentAhead, OneThatIsNotToBeReconstructedIsNotSent) {
    test::Simulator simulator(session, {.policy = UploadPolicy::every_nth, .nth = 3});
    gate.release(3);
    for (std::uint64_t i = 0; i < 8; ++i) simulator.send(i, particles);
    simulator.end();
    EXPECT_EQ(simulator.receive_story().size(), 8U);
    EXPECT_EQ(receiver->sent(), 3U);
    EXPECT_EQ(as_sent, 3);
}

TEST_F(FramesSentAhead, WhatWaitsInASessionThatEndsIsWithdrawn) {
    test::Simulator simulator(session, {});
    simulator.send(0, particles);
    begun.wait(0);
    simulator.send(1, particles);
    session.close();
    EXPECT_EQ(receiver->ahead(), 1U) << "the one that is worked at";
    gate.release(1);
    session.join();
    EXPECT_EQ(receiver->ahead(), 0U);
}

}  // namespace
}  // namespace meniscus::server
