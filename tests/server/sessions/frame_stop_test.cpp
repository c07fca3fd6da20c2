// A frame under way ends when nobody wants it any more, or when it has had the device for as long as it may.
#include "sessions/intake/frame_stop.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <latch>
#include <limits>
#include <memory>
#include <semaphore>
#include <string>
#include <thread>

#include "meniscus/error.hpp"
#include "sessions/session/session.hpp"
#include "sessions/session/session_registry.hpp"
#include "simulator_player.hpp"
#include "test_frames.hpp"

namespace meniscus::server {
namespace {

using std::chrono::milliseconds;
using test::id;
using test::Simulator;

/// Reconstructs without end, until it is stopped.
struct Endless {
    std::shared_ptr<StopFlag> flag = std::make_shared<StopFlag>();
    std::counting_semaphore<> began{0};
    std::counting_semaphore<> stopped{0};

    ReconstructFunctions functions() {
        return {.reconstruct = [this](const ParticleFrame&, Mesh&) -> Reconstructed {
                    began.release();
                    while (!flag->is_raised()) std::this_thread::yield();
                    stopped.release();
                    throw Stopped();
                },
                .stop = flag};
    }
};

struct FrameStops : testing::Test {
    Endless endless;
    SharedResources shared{.workers = std::make_shared<WorkerPool>(1)};
    const test::Particles particles = test::wave(4, 0.0);

    std::unique_ptr<Session> make_session(milliseconds longest) {
        return std::make_unique<Session>(SessionIdentity{.id = id}, test::settings(), Limits{.frame_time = longest},
                                         endless.functions(), shared);
    }
};

TEST_F(FrameStops, WhenItsStreamIsCanceled) {
    const auto session = make_session(milliseconds(0));
    Simulator simulator(*session, {});
    simulator.send(0, particles);
    endless.began.acquire();
    session->cancel_upload(simulator.upload);
    endless.stopped.acquire();
    // The session lives on: another stream's frame begins.
    Simulator next(*session, {});
    next.send(0, particles);
    endless.began.acquire();
    session->close();
}

TEST_F(FrameStops, WhenItsSessionIsClosed) {
    const auto session = make_session(milliseconds(0));
    Simulator simulator(*session, {});
    simulator.send(0, particles);
    endless.began.acquire();
    session->close();
    endless.stopped.acquire();
    EXPECT_TRUE(simulator.receive_all().empty());
    session->join();
}

TEST_F(FrameStops, WhenItHasHadTheDeviceForItsTime) {
    const auto session = make_session(milliseconds(50));
    Simulator simulator(*session, {});
    simulator.send(7, particles);
    EXPECT_TRUE(simulator.receive_all().empty());
    try {
        std::rethrow_exception(simulator.error);
    } catch (const LimitExceeded& error) {
        EXPECT_EQ(std::string(error.what()),
                  "frame 7: it has had the device for 0.05 s, as long as the server gives to one frame: use a larger "
                  "cell size or fewer particles");
    }
    simulator.end();
}

TEST_F(FrameStops, AndTheNextSessionsTurnBegins) {
    const auto session = make_session(milliseconds(50));
    Session other({.id = id}, test::settings(), {}, {.reconstruct = test::reconstruct_on_the_cpu()}, shared);
    Simulator simulator(*session, {});
    Simulator others(other, {});
    simulator.send(0, particles);
    endless.began.acquire();
    others.send(3, particles);
    others.end();
    EXPECT_EQ(others.receive_all(), std::vector<std::uint64_t>{3});
}

TEST_F(FrameStops, ButTheWaitForItsTurnIsNotCounted) {
    constexpr milliseconds longest(200);
    const auto session = make_session(longest);
    Simulator simulator(*session, {});
    std::optional<Turns::Turn> turn = shared.turns->wait({}, "another");
    simulator.send(0, particles);
    while (shared.turns->waiting() == 0) std::this_thread::yield();
    std::this_thread::sleep_for(longest * 2);
    const auto given = std::chrono::steady_clock::now();
    turn.reset();
    endless.stopped.acquire();
    EXPECT_GE(std::chrono::steady_clock::now() - given, longest);
}

TEST(FrameStop, EndsAFrameThatWasCanceledBeforeItBegan) {
    const auto flag = std::make_shared<StopFlag>();
    FrameStop stop(flag, std::make_shared<Timer>(), milliseconds(0));
    Upload upload(
        {}, [](std::size_t /*part*/) {}, [] {});
    Upload other(
        {}, [](std::size_t /*part*/) {}, [] {});
    stop.cancel(upload);
    EXPECT_FALSE(flag->is_raised());
    {
        const FrameStop::UnderWay frame(stop, &other);
        EXPECT_FALSE(flag->is_raised());
    }
    {
        const FrameStop::UnderWay frame(stop, &upload);
        EXPECT_TRUE(flag->is_raised());
        EXPECT_EQ(stop.reason(), FrameStop::Reason::canceled);
    }
    stop.close();
    const FrameStop::UnderWay frame(stop, &other);
    EXPECT_TRUE(flag->is_raised());
    EXPECT_EQ(stop.reason(), FrameStop::Reason::closed);
}

TEST(Timer, CallsAtTheirTimesInWhateverOrderTheyWereAdded) {
    Timer timer;
    const auto start = Timer::Clock::now();
    std::vector<int> called;
    std::latch all(3);
    const auto at = [&](int ms) {
        timer.at(start + milliseconds(ms), [&, ms] {
            called.push_back(ms);
            EXPECT_GE(Timer::Clock::now(), start + milliseconds(ms));
            all.count_down();
        });
    };
    at(30);
    at(10);
    timer.remove(timer.at(start, [&] { called.push_back(-1); }));
    at(20);
    all.wait();
    std::erase(called, -1);  // whether it was called before it was removed is left to chance
    EXPECT_EQ(called, (std::vector<int>{10, 20, 30}));
}

TEST(Timer, CallsAgainAndAgain) {
    int calls = 0;
    std::latch three(3);
    Timer timer;
    const auto start = Timer::Clock::now();
    timer.every(milliseconds(5), [&] {
        EXPECT_GE(Timer::Clock::now(), start + ++calls * milliseconds(5));
        if (calls <= 3) three.count_down();
    });
    three.wait();
}

TEST(FrameOfARealSession, IsStoppedAfterItsTimeAndTheNextIsAnswered) {
    // Tens of seconds of work.
    test::Particles fine = test::wave(60, 0.0);
    Settings settings = test::settings();
    settings.cell_size = 0.1;
    SessionRegistry registry({.work_per_frame = 0.0, .frame_time = milliseconds(300)}, {.backend = Backend::cpu}, 1);
    const auto session = registry.create(id, settings).session;
    Simulator simulator(*session, {});
    const auto start = std::chrono::steady_clock::now();
    simulator.send(0, fine);
    EXPECT_TRUE(simulator.receive_all().empty());
    EXPECT_THROW(std::rethrow_exception(simulator.error), LimitExceeded);
    EXPECT_LT(std::chrono::steady_clock::now() - start, milliseconds(300) + 5 * milliseconds(200));
    simulator.end();
    Simulator next(*session, {});
    next.send(1, test::wave(1, 0.0));
    next.end();
    EXPECT_EQ(next.receive_all(), std::vector<std::uint64_t>{1});
}

TEST(FrameOfARealSession, ThatIsRefusedKeepsTheSurfaceForTheWatcherOfACoarserLevel) {
    SessionRegistry registry({}, {.backend = Backend::cpu}, 1);
    const auto session = registry.create(id, test::settings()).session;
    Simulator simulator(*session, {});
    simulator.send(0, test::wave(6, 0.0));
    test::Particles bad = test::wave(6, 0.0);
    bad.positions[4] = std::numeric_limits<float>::quiet_NaN();
    simulator.send(1, bad);
    EXPECT_EQ(simulator.receive_all(), std::vector<std::uint64_t>{0});
    EXPECT_THROW(std::rethrow_exception(simulator.error), InvalidInput);
    std::counting_semaphore<> awake{0};
    WatchOptions options{.format = {.position_bits = 6, .normal_bits = 8}};
    options.format.max_level = 1;
    const auto watch = session->open_watch(options, [&] { awake.release(); });
    // A message comes: the mesh that was there before.
    for (;;) {
        const auto next = watch->take();
        if (std::holds_alternative<SharedMessage>(next)) break;
        ASSERT_FALSE(std::holds_alternative<Watch::End>(next));
        ASSERT_TRUE(awake.try_acquire_for(std::chrono::seconds(20))) << "the watcher sees nothing";
    }
    session->close_watch(watch);
}

}  // namespace
}  // namespace meniscus::server
