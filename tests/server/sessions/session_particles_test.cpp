// A session's particles as its watchers find them, without sockets.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <semaphore>

#include "meniscus/v1/surface_service.pb.h"
#include "sessions/session/session.hpp"
#include "simulator_player.hpp"

namespace meniscus::server {
namespace {

using test::id;
using test::Simulator;

/// Plays a watcher of particles.
struct ParticleSpectator {
    ParticleSpectator(Session& s, std::uint64_t max_particles)
        : session(s),
          watch(session.open_watch({.format = {}, .max_particles = max_particles}, [this] { awake.release(); })) {}
    ~ParticleSpectator() { session.close_watch(watch); }

    /// The messages of the next frame, none at the end.
    std::vector<SharedMessage> receive() {
        std::vector<SharedMessage> messages;
        for (;;) {
            auto next = watch->take();
            if (const auto* message = std::get_if<SharedMessage>(&next)) {
                messages.push_back(*message);
                v1::WatchParticlesResponse response;
                EXPECT_TRUE(response.ParseFromString(**message));
                if (response.has_particles_begin()) index = response.particles_begin().frame_index();
                if (response.has_frame_end()) return messages;
                continue;
            }
            if (std::holds_alternative<Watch::End>(next)) return {};
            awake.acquire();
        }
    }

    Session& session;
    std::counting_semaphore<> awake{0};
    std::shared_ptr<Watch> watch;
    std::uint64_t index = 0;  ///< of the last frame received
};

struct SessionParticles : testing::Test {
    Session session{{.id = id},
                    test::settings(),
                    Limits{},
                    {.reconstruct = test::reconstruct_on_the_cpu(), .emit_capped = {}},
                    {.workers = std::make_shared<WorkerPool>(1)}};
    const test::Particles particles = test::wave(4, 0.0);

    void send_one(std::uint64_t index, const UploadOptions& options = {}) {
        Simulator simulator(session, options);
        simulator.send(index, particles);
        simulator.end();
        simulator.receive_all();
    }
};

TEST_F(SessionParticles, AreEncodedOnceForAllThatAskForAsMany) {
    ParticleSpectator first(session, 10);
    ParticleSpectator second(session, 10);
    ParticleSpectator other(session, 20);
    send_one(0);
    const auto messages = first.receive();
    EXPECT_EQ(second.receive(), messages);
    EXPECT_NE(other.receive(), messages);
    ParticleSpectator late(session, 10);
    EXPECT_EQ(late.receive(), messages);
}

TEST_F(SessionParticles, AreEncodedOnceForAllNumbersThatAskForTheSameOfThem) {
    ParticleSpectator all(session, 0);
    ParticleSpectator more_than_there_are(session, 1'000'000);
    ParticleSpectator half(session, 32);
    ParticleSpectator a_little_more_than_half(session, 40);  // of 64: every second one, too
    send_one(0);
    const auto messages = all.receive();
    EXPECT_EQ(more_than_there_are.receive(), messages);
    const auto every_second = half.receive();
    EXPECT_NE(every_second, messages);
    EXPECT_EQ(a_little_more_than_half.receive(), every_second);
    ParticleSpectator late(session, 64);
    EXPECT_EQ(late.receive(), messages);
}

TEST_F(SessionParticles, TakeNoMemoryOnceNobodyWatchesThem) {
    std::weak_ptr<const std::string> message;
    {
        ParticleSpectator one(session, 0);
        ParticleSpectator another(session, 0);
        send_one(0);
        message = one.receive().front();
        another.receive();
    }
    EXPECT_TRUE(message.expired());
}

TEST_F(SessionParticles, OfAResumedRunAreShownOnce) {
    ParticleSpectator spectator(session, 0);
    send_one(3, {.run_id = 9});
    spectator.receive();
    EXPECT_EQ(spectator.index, 3U);
    send_one(3, {.run_id = 9});
    EXPECT_TRUE(std::holds_alternative<Watch::Nothing>(spectator.watch->take()));
    send_one(4, {.run_id = 9});
    spectator.receive();
    EXPECT_EQ(spectator.index, 4U);
}

/// Waits in the midst of showing a frame's particles.
struct WaitingObserver : SessionObserver {
    const char* product() const noexcept override { return "test"; }
    void reconstructed(const InputFrame& /*frame*/) noexcept override {
        showing.release();
        in_time = go_on.try_acquire_for(std::chrono::seconds(20));
    }
    void encoded(std::shared_ptr<const EncodedFrame> /*frame*/) noexcept override {}

    std::binary_semaphore showing{0};
    std::binary_semaphore go_on{0};
    std::atomic<bool> in_time{false};
};

TEST(SessionParticlesOfTwo, AreShownWhileAnotherSessionHasItsTurnOnTheDevice) {
    const auto observer = std::make_shared<WaitingObserver>();
    const auto turns = std::make_shared<Turns>();
    const auto make = [&](SessionObservers observed) {
        return std::make_unique<Session>(
            SessionIdentity{.id = id}, test::settings(), Limits{},
            ReconstructFunctions{.reconstruct = test::reconstruct_on_the_cpu(), .emit_capped = {}},
            SharedResources{.workers = std::make_shared<WorkerPool>(1), .turns = turns}, std::move(observed));
    };
    const auto shown = make({observer});
    const auto other = make({});
    Simulator simulator(*shown, {});
    simulator.send(0, test::wave(4, 0.0));
    observer->showing.acquire();
    Simulator another(*other, {});
    another.send(0, test::wave(4, 0.0));
    another.end();
    another.receive_all();
    observer->go_on.release();
    simulator.end();
    simulator.receive_all();
    EXPECT_TRUE(observer->in_time) << "the other session waited for the particles";
}

TEST_F(SessionParticles, OfAWatcherThatDoesNotReadAreTheNewestAlone) {
    ParticleSpectator spectator(session, 0);
    for (std::uint64_t i = 0; i < 5; ++i) send_one(i);
    spectator.receive();
    EXPECT_EQ(spectator.index, 4U);
    EXPECT_EQ(session.state().frames_skipped, 4U);
}

}  // namespace
}  // namespace meniscus::server
