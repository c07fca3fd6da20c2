// The memory that a long frame may hold, and frames of others beside it.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <semaphore>
#include <string>
#include <thread>
#include <vector>

#include "meniscus/error.hpp"
#include "meniscus/memory.hpp"
#include "sessions/session/session_registry.hpp"
#include "simulator_player.hpp"
#include "test_frames.hpp"

namespace meniscus::server {
namespace {

constexpr std::size_t total = 64 << 20;
constexpr std::size_t beside = total / 8;

/// A session whose frame takes all the memory that it may have, and lasts until the test ends it; and others.
struct BesideALongFrame : testing::Test {
    BesideALongFrame() {
        busy.send(0, particles);
        began.acquire();
    }
    ~BesideALongFrame() override { end_of_long_frame.release(); }

    /// Of a session whose frames need this many bytes each, beside the particles.
    ReconstructFunctions functions_that_need(std::size_t bytes) {
        const auto account = std::make_shared<MemoryAccount>(total - beside, "in memory", memory);
        return {
            .reconstruct =
                [this, bytes, account, cpu = test::reconstruct_on_the_cpu()](const ParticleFrame& frame, Mesh& mesh) {
                    ++tries;
                    limit_of_last_try = account->limit();
                    account->charge(bytes);
                    account->release(bytes);
                    return cpu(frame, mesh);
                },
            .limit_memory = [account](std::size_t limit) { account->set_limit(limit); }};
    }
    std::unique_ptr<Session> session_that_needs(std::size_t bytes) {
        return std::make_unique<Session>(SessionIdentity{.id = std::to_string(bytes)}, test::settings(), limits,
                                         functions_that_need(bytes), shared);
    }
    static std::vector<std::uint64_t> answers_of(Session& session, const test::Particles& particles) {
        test::Simulator simulator(session, {});
        simulator.send(0, particles);
        simulator.end();
        auto answers = simulator.receive_all();
        EXPECT_EQ(simulator.error, nullptr);
        return answers;
    }

    const Limits limits{.bytes_per_session = total - beside, .total_bytes = total};
    const std::shared_ptr<SharedMemory> memory = std::make_shared<SharedMemory>(total);
    const SharedResources shared{.workers = std::make_shared<WorkerPool>(1),
                                 .turns = std::make_shared<Turns>(std::chrono::milliseconds(1))};
    const test::Particles particles = test::wave(2, 0.0);
    std::binary_semaphore began{0};
    std::binary_semaphore end_of_long_frame{0};
    std::atomic<int> tries{0};
    std::atomic<std::size_t> limit_of_last_try{0};
    Session long_one{{.id = "long"},
                     test::settings(),
                     limits,
                     {.reconstruct =
                          [this, cpu = test::reconstruct_on_the_cpu()](const ParticleFrame& frame, Mesh& mesh) {
                              MemoryAccount account(limits.bytes_per_session, "in memory", memory);
                              account.charge(limits.bytes_per_session);
                              began.release();
                              end_of_long_frame.acquire();
                              account.release(limits.bytes_per_session);
                              return cpu(frame, mesh);
                          }},
                     shared};
    test::Simulator busy{long_one, {}};
};

TEST_F(BesideALongFrame, AFrameIsAnsweredForWhichThereIsMemoryThatNoOtherMayTake) {
    const auto small = session_that_needs(beside);
    EXPECT_EQ(answers_of(*small, particles), std::vector<std::uint64_t>{0});
    EXPECT_EQ(tries, 1);
    EXPECT_EQ(limit_of_last_try, beside);
}

TEST_F(BesideALongFrame, AFrameForWhichThatIsTooLittleIsNotRefusedButWaitsForItsEnd) {
    const auto large = session_that_needs(beside + 1);
    test::Simulator waiting(*large, {});
    waiting.send(0, particles);
    waiting.end();
    while (tries != 1 || large->state().wait != SessionWait::device) std::this_thread::yield();
    EXPECT_EQ(limit_of_last_try, beside);
    const auto small = session_that_needs(1);
    EXPECT_EQ(answers_of(*small, particles), std::vector<std::uint64_t>{0}) << "it passes by";
    EXPECT_EQ(large->state().wait, SessionWait::device);

    end_of_long_frame.release();
    EXPECT_EQ(waiting.receive_all(), std::vector<std::uint64_t>{0});
    EXPECT_EQ(waiting.error, nullptr);
    EXPECT_EQ(tries, 3);
    EXPECT_EQ(limit_of_last_try, limits.bytes_per_session);
    EXPECT_EQ(answers_of(*large, particles), std::vector<std::uint64_t>{0});
    EXPECT_EQ(limit_of_last_try, limits.bytes_per_session);
    end_of_long_frame.release();
}

TEST_F(BesideALongFrame, AFrameThatNeedsMoreThanItsSessionMayHoldIsRefusedOnceItLeads) {
    const auto too_large = session_that_needs(limits.bytes_per_session + 1);
    test::Simulator refused(*too_large, {});
    refused.send(0, particles);
    while (tries != 1 || too_large->state().wait != SessionWait::device) std::this_thread::yield();
    end_of_long_frame.release();
    EXPECT_TRUE(refused.receive_all().empty());
    EXPECT_THROW(std::rethrow_exception(refused.error), MemoryLimitExceeded);
    EXPECT_EQ(tries, 2);
    refused.end();
    end_of_long_frame.release();
}

TEST_F(BesideALongFrame, ASessionEndsThatWaitsToLead) {
    const auto large = session_that_needs(beside + 1);
    test::Simulator waiting(*large, {});
    waiting.send(0, particles);
    while (tries != 1 || large->state().wait != SessionWait::device) std::this_thread::yield();
    large->close();
    large->join();
    EXPECT_EQ(tries, 1);
}

}  // namespace
}  // namespace meniscus::server
