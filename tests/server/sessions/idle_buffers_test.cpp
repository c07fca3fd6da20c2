// Memory of reconstructions that sessions share: what idle ones give back, and that nobody notices.
#include <gtest/gtest.h>

#include <limits>
#include <semaphore>
#include <string>
#include <thread>
#include <vector>

#include "meniscus/v1/surface_service.pb.h"
#include "sessions/limits/refusal.hpp"
#include "sessions/session/session_registry.hpp"
#include "simulator_player.hpp"

namespace meniscus::server {
namespace {

using test::Simulator;

std::string session_id(int number) {
    return fmt::format("00000000-0000-4000-8000-{:012}", number);
}

/// The messages of the newest frame to a watcher: the beginning and the bricks, or the particles.
std::vector<std::string> first_frame(Session& session, const WatchOptions& options) {
    std::counting_semaphore<> awake{0};
    const auto watch = session.open_watch(options, [&] { awake.release(); });
    std::vector<std::string> messages;
    for (bool ended = false; !ended;) {
        auto next = watch->take();
        if (const auto* message = std::get_if<SharedMessage>(&next)) {
            if (options.max_particles) {
                v1::WatchParticlesResponse response;
                EXPECT_TRUE(response.ParseFromString(**message));
                ended = response.has_frame_end();
                messages.push_back(**message);
                continue;
            }
            v1::WatchResponse response;
            EXPECT_TRUE(response.ParseFromString(**message));
            ended = response.has_frame_statistics();
            if (!ended) messages.push_back(**message);
        } else if (std::holds_alternative<Watch::End>(next)) {
            ADD_FAILURE() << "no frame came";
            break;
        } else {
            awake.acquire();
        }
    }
    session.close_watch(watch);
    return messages;
}

/// An answered frame.
void send(Session& session, std::uint64_t index, const test::Particles& particles) {
    Simulator simulator(session, {.run_id = 9});
    simulator.send(index, particles);
    simulator.end();
    EXPECT_EQ(simulator.receive_all(), std::vector<std::uint64_t>{index});
    EXPECT_EQ(simulator.error, nullptr);
}

void wait_until_resting(const Session& session) {
    while (!session.resting_since()) std::this_thread::yield();
}

struct IdleBuffersOfASession : testing::Test {
    const BackendOptions cpu{.backend = Backend::cpu, .threads = 1};
    SessionRegistry registry{Limits{}, cpu, 1};
    SessionRegistry other_registry{Limits{}, cpu, 1};
    const std::shared_ptr<Session> session = registry.create(session_id(1), test::settings()).session;
    /// It never gives its buffers back.
    const std::shared_ptr<Session> other = other_registry.create(session_id(1), test::settings()).session;
    const test::Particles particles = test::wave(6, 0.0);
    /// The newest particles.
    const std::size_t kept = particles.positions.size() * sizeof(float);

    /// Unless that has been done.
    void release() {
        while (!session->resting_since()) {
            if (registry.reconstruction_bytes() <= kept) return;
            std::this_thread::yield();
        }
        session->release_buffers().wait();
    }

    std::vector<WatchOptions> mesh_options() const {
        std::vector<WatchOptions> all;
        for (const int max_level : {1, 2, 3})
            for (const int position_bits : {static_cast<int>(offset_bits(test::settings())), 4})
                for (const int normal_bits : {0, 8})
                    all.push_back({.format = {.max_level = max_level,
                                              .position_bits = position_bits,
                                              .normal_bits = normal_bits,
                                              .codec = Codec::draco}});
        all.push_back(all.back());
        all.back().region = Box{.min = {0.0, 0.0, 0.0}, .max = {0.1, 0.1, 0.1}};
        return all;
    }
};

TEST_F(IdleBuffersOfASession, AreGivenBack) {
    send(*session, 3, particles);
    EXPECT_GT(registry.reconstruction_bytes(), kept);
    release();
    EXPECT_EQ(registry.reconstruction_bytes(), kept);
}

TEST_F(IdleBuffersOfASession, AreGivenBackOfFramesThatNeverBecameComplete) {
    const auto give_back = [&](InputFrame& input) {
        input.allocate(1'000'000);
        EXPECT_EQ(registry.reconstruction_bytes(), 0U) << "in flight they have a limit of their own";
        session->return_input(input);
        return true;
    };
    session->request_input(give_back);
    EXPECT_GE(registry.reconstruction_bytes(), 1'000'000U) << "what stays counts among the memory of all";
    release();
    EXPECT_EQ(registry.reconstruction_bytes(), 0U);
}

TEST_F(IdleBuffersOfASession, AreNotMissedByWhoJoinsLater) {
    for (Session* each : {session.get(), other.get()}) send(*each, 3, particles);
    for (const WatchOptions& options : mesh_options()) {
        release();
        EXPECT_EQ(registry.reconstruction_bytes(), kept);
        const auto messages = first_frame(*session, options);
        EXPECT_FALSE(messages.empty());
        EXPECT_EQ(messages, first_frame(*other, options)) << options.format.max_level;
    }
    release();
    for (const std::uint64_t most : {0U, 50U})
        EXPECT_EQ(first_frame(*session, {.format = {}, .max_particles = most}),
                  first_frame(*other, {.format = {}, .max_particles = most}));
}

TEST_F(IdleBuffersOfASession, AreTakenAgainByTheNextFrame) {
    for (Session* each : {session.get(), other.get()}) send(*each, 3, particles);
    release();
    const test::Particles next = test::wave(6, 1.0);
    for (Session* each : {session.get(), other.get()}) send(*each, 4, next);
    for (const WatchOptions& options : mesh_options())
        EXPECT_EQ(first_frame(*session, options), first_frame(*other, options)) << options.format.max_level;
}

TEST_F(IdleBuffersOfASession, AreGivenBackAfterAFrameThatWasRefused) {
    send(*session, 3, particles);
    test::Particles bad = particles;
    bad.positions[0] = std::numeric_limits<float>::quiet_NaN();
    for (const std::uint64_t index : {4U, 5U}) {
        Simulator simulator(*session, {.run_id = 9});
        simulator.send(index, bad);
        simulator.receive_all();
        EXPECT_NE(simulator.error, nullptr);
    }
    const std::size_t before = registry.reconstruction_bytes();
    release();
    EXPECT_LT(registry.reconstruction_bytes(), before);
    WatchOptions new_options = mesh_options().back();
    new_options.format.normal_bits = 11;
    EXPECT_FALSE(first_frame(*session, new_options).empty()) << "the mesh of the good frame stays";
}

TEST(IdleBuffers, AreGivenBackAfterTheTimeOfTheLimit) {
    SessionRegistry registry{Limits{.idle_buffers_time = std::chrono::milliseconds(20)},
                             BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
    const auto session = registry.create(session_id(1), test::settings()).session;
    const test::Particles particles = test::wave(4, 0.0);
    send(*session, 0, particles);
    const std::size_t kept = particles.positions.size() * sizeof(float);
    while (registry.reconstruction_bytes() > kept) std::this_thread::yield();
}

TEST(IdleBuffers, OfLargeSessionsMakeRoomForSmallOnes) {
    const BackendOptions cpu{.backend = Backend::cpu, .threads = 1};
    const test::Particles large = test::wave(16, 0.0);
    const test::Particles small = test::wave(4, 0.0);
    std::size_t bytes_of_large = 0;
    {
        SessionRegistry alone{Limits{}, cpu, 1};
        const auto session = alone.create(session_id(0), test::settings()).session;
        send(*session, 0, large);
        bytes_of_large = alone.reconstruction_bytes();
    }
    SessionRegistry registry{Limits{.sessions = 16, .total_bytes = 2 * bytes_of_large}, cpu, 1};
    std::vector<std::shared_ptr<Session>> sessions;
    sessions.reserve(16);
    for (int i = 0; i < 16; ++i) sessions.push_back(registry.create(session_id(i), test::settings()).session);
    for (std::uint64_t frame = 0; frame < 3; ++frame)
        for (std::size_t i = 0; i < sessions.size(); ++i) {
            send(*sessions[i], frame, i < 6 ? large : small);
            EXPECT_LE(registry.reconstruction_bytes(), 2 * bytes_of_large);
            wait_until_resting(*sessions[i]);
        }
}

TEST(IdleBuffers, CannotMakeRoomForASessionThatIsTooLargeAlone) {
    SessionRegistry registry{Limits{.total_bytes = 100'000}, BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
    const auto session = registry.create(session_id(1), test::settings()).session;
    Simulator simulator(*session, {});
    simulator.send(0, test::wave(16, 0.0));
    simulator.receive_all();
    ASSERT_NE(simulator.error, nullptr);
    EXPECT_THROW(std::rethrow_exception(simulator.error), LimitExceeded);
}

}  // namespace
}  // namespace meniscus::server
