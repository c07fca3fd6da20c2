#include "sessions/session/session_registry.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <optional>
#include <semaphore>
#include <thread>
#include <vector>

#include "meniscus/error.hpp"
#include "opened_upload.hpp"
#include "sessions/limits/refusal.hpp"
#include "simulator_player.hpp"

namespace meniscus::server {
namespace {

constexpr const char* first_id = "00000000-0000-4000-8000-000000000001";
constexpr const char* second_id = "00000000-0000-4000-8000-000000000002";
constexpr const char* third_id = "00000000-0000-4000-8000-000000000003";

struct Registry : testing::Test {
    SessionRegistry registry{Limits{.sessions = 2}, BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
};

TEST_F(Registry, JoinsASessionWithEqualSettings) {
    EXPECT_EQ(registry.create(first_id, test::settings()).session, registry.create(first_id, test::settings()).session);
    EXPECT_EQ(registry.list().size(), 1U);
}

TEST_F(Registry, RefusesOtherSettingsUnderTheSameId) {
    registry.create(first_id, test::settings());
    Settings other = test::settings();
    other.iso = 0.5;
    try {
        registry.create(first_id, other);
        FAIL();
    } catch (const Refusal& refusal) {
        EXPECT_EQ(refusal.kind(), Refusal::Kind::already_exists);
    }
}

TEST_F(Registry, RefusesSessionsPastTheLimitUntilOneIsRemoved) {
    const auto first = registry.create(first_id, test::settings()).session;
    registry.create(second_id, test::settings());
    EXPECT_THROW(registry.create(third_id, test::settings()), LimitExceeded);
    EXPECT_NO_THROW(registry.create(second_id, test::settings()));
    registry.remove(first);
    EXPECT_NO_THROW(registry.create(third_id, test::settings()));
}

TEST_F(Registry, ListsSessionsInTheOrderOfTheirIds) {
    registry.create(second_id, test::settings());
    registry.create(first_id, test::settings());
    EXPECT_EQ(registry.list()[0]->id(), first_id);
    EXPECT_EQ(registry.list()[1]->id(), second_id);
}

TEST_F(Registry, KnowsNoSessionThatWasRemoved) {
    const auto first = registry.create(first_id, test::settings()).session;
    registry.remove(first);
    EXPECT_THROW(registry.find(first_id), Refusal);
    EXPECT_THROW(registry.remove(first), Refusal);
}

TEST_F(Registry, RemovesTheSessionThatWasMeantAndNotItsSuccessorOfTheSameId) {
    const auto first = registry.create(first_id, test::settings()).session;
    registry.remove(first);
    const auto successor = registry.create(first_id, test::settings()).session;
    EXPECT_THROW(registry.remove(first), Refusal);
    EXPECT_EQ(registry.find(first_id), successor);
}

TEST_F(Registry, ForgetsASessionThatEndedByItself) {
    const auto ended = registry.create(first_id, test::settings()).session;
    registry.create(second_id, test::settings());
    ended->close();
    EXPECT_THROW(registry.find(first_id), Refusal);
    EXPECT_EQ(registry.list().size(), 1U);
    EXPECT_NE(registry.create(first_id, test::settings()).session, ended);
}

TEST_F(Registry, FreesTheMemoryOfADeletedSessionThatACallStillHolds) {
    const auto session = registry.create(first_id, test::settings()).session;
    test::Simulator simulator(*session, {.receive_meshes = true});
    simulator.send(0, test::wave(6, 0.0));
    simulator.end();
    simulator.receive_all();
    EXPECT_GT(registry.reconstruction_bytes(), 0U);
    registry.remove(session);
    while (registry.reconstruction_bytes() != 0) std::this_thread::yield();
}

TEST(EndedRegistry, HasEndedTheThreadsOfItsSessionsThoughCallsHoldThem) {
    struct Ending : SessionObserver {
        const char* product() const noexcept override { return "nothing"; }
        void reconstructed(const InputFrame& /*frame*/) noexcept override {}
        void encoded(std::shared_ptr<const EncodedFrame> /*frame*/) noexcept override {}
        void ended() noexcept override { has_ended = true; }
        std::atomic<bool> has_ended{false};
    };
    std::vector<std::shared_ptr<Ending>> endings;
    const auto observe = [&](const SessionIdentity& /*identity*/, const Settings& /*settings*/) {
        endings.push_back(std::make_shared<Ending>());
        return SessionObservers{endings.back()};
    };
    std::optional<SessionRegistry> registry(std::in_place, Limits{},
                                            BackendOptions{.backend = Backend::cpu, .threads = 1}, 1,
                                            std::vector<int>{}, std::make_shared<Metrics>(), observe);
    std::vector<std::shared_ptr<Session>> held;
    for (const char* id : {first_id, second_id, third_id})
        held.push_back(registry->create(id, test::settings()).session);
    registry->remove(held[0]);
    held[1]->close();
    registry.reset();
    for (const auto& ending : endings) EXPECT_TRUE(ending->has_ended);
    for (const auto& session : held) EXPECT_TRUE(session->ended());
}

TEST_F(Registry, TakesNoSessionsWhileItDrains) {
    const auto session = registry.create(first_id, test::settings()).session;
    registry.drain(std::chrono::seconds(1));
    EXPECT_THROW(registry.create(second_id, test::settings()), Refusal);
    EXPECT_THROW(test::open_upload(*session), Refusal);
}

TEST(IdleRegistry, ForgetsASessionThatNobodyHasUsedForAsLongAsTheLimitSaysAndNoneBefore) {
    using Clock = std::chrono::steady_clock;
    constexpr auto limit = std::chrono::hours(1);
    SessionRegistry registry{Limits{.idle_time = limit}, BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
    const auto before = Clock::now();
    const auto used = registry.create(first_id, test::settings()).session;
    const auto upload = test::open_upload(*used);
    registry.create(second_id, test::settings());
    const auto after = Clock::now();
    registry.end_idle(before + limit - std::chrono::milliseconds(1));
    EXPECT_EQ(registry.list().size(), 2U);
    registry.end_idle(after + limit);
    ASSERT_EQ(registry.list().size(), 1U);
    EXPECT_EQ(registry.list()[0], used);
    const auto end = std::get<OutputQueue::End>(upload->output.take());
    EXPECT_THROW(std::rethrow_exception(end.error), LimitExceeded);
}

/// A registry whose reconstructions wait for the test.
struct BusyRegistry : testing::Test {
    ~BusyRegistry() override { gate.release(1000); }

    std::counting_semaphore<> gate{0};  ///< one reconstruction for each
    std::atomic<int> begun{0};
    SessionRegistry registry{
        Limits{.sessions = 4},
        BackendOptions{.backend = Backend::cpu, .threads = 1},
        1,
        {},
        std::make_shared<Metrics>(),
        nullptr,
        [this](const Settings&, const BackendOptions&) {
            return ReconstructFunctions{
                .reconstruct = [this, cpu = test::reconstruct_on_the_cpu()](const ParticleFrame& frame, Mesh& mesh) {
                    ++begun;
                    gate.acquire();
                    return cpu(frame, mesh);
                }};
        }};
    const test::Particles particles = test::wave(2, 0.0);
};

TEST_F(BusyRegistry, LetsDeletedSessionsEndWhoseFramesWaitForTheDevice) {
    const auto busy = registry.create(first_id, test::settings()).session;
    test::Simulator holds(*busy, {});
    holds.send(0, particles);
    while (begun == 0) std::this_thread::yield();
    for (int i = 0; i < 50; ++i) {
        auto session = registry.create(second_id, test::settings()).session;
        auto waiting = std::make_unique<test::Simulator>(*session, UploadOptions{});
        waiting->send(0, particles);
        registry.remove(session);
        waiting.reset();
        const std::weak_ptr<Session> ended = session;
        session.reset();
        while (!ended.expired()) std::this_thread::yield();
    }
    EXPECT_EQ(begun, 1) << "the device was busy all the time";
}

TEST_F(BusyRegistry, GivesTheBytesOfADeletedSessionsFramesToOthers) {
    const auto session = registry.create(first_id, test::settings()).session;
    std::exception_ptr told;
    InputFrame* lent = nullptr;
    const auto upload = test::open_upload(
        *session, {}, [](std::size_t /*part*/) {}, [] {},
        [&](std::exception_ptr error) {
            told = std::move(error);
            session->return_input(*std::exchange(lent, nullptr));
        });
    const auto begin = [&](InputFrame& input) {
        input.particle_count = 1;
        input.allocate(12);
        lent = &input;
        return true;
    };
    for (int i = 0; i < 2; ++i) {
        session->request_input(begin);
        while (lent == nullptr) std::this_thread::yield();
        if (i == 0) session->submit(upload, *std::exchange(lent, nullptr));
        while (begun == 0) std::this_thread::yield();
    }
    EXPECT_EQ(registry.bytes_in_flight(), 24U);
    registry.remove(session);
    EXPECT_EQ(registry.bytes_in_flight(), 12U) << "the device has one";
    EXPECT_THROW(std::rethrow_exception(told), Refusal);
    gate.release();
    while (registry.bytes_in_flight() != 0) std::this_thread::yield();
}

TEST_F(BusyRegistry, CountsDeletedSessionsThatHaveNotEnded) {
    std::vector<std::unique_ptr<test::Simulator>> simulators;
    // Each has the device when it is deleted, one after the other; none of them can be stopped.
    const auto first = registry.create(first_id, test::settings()).session;
    simulators.push_back(std::make_unique<test::Simulator>(*first, UploadOptions{}));
    simulators.back()->send(0, particles);
    while (begun == 0) std::this_thread::yield();
    registry.remove(first);
    for (int i = 0; i < 7; ++i) registry.remove(registry.create(second_id, test::settings()).session);
    EXPECT_THROW(registry.create(second_id, test::settings()), LimitExceeded) << "eight are about to end";
    gate.release();
    for (bool refused = true; refused;) {
        try {
            registry.create(second_id, test::settings());
            refused = false;
        } catch (const LimitExceeded&) {
            std::this_thread::yield();
        }
    }
    EXPECT_EQ(registry.list().size(), 1U);
}

TEST_F(BusyRegistry, GivesTurnsToCallersHoweverManySessionsEachHas) {
    std::vector<std::unique_ptr<test::Simulator>> simulators;
    std::vector<std::shared_ptr<Session>> sessions;
    const auto send = [&](const char* id, const std::string& name) {
        sessions.push_back(
            registry.create(id, test::settings(), {.name = name, .account = registry.account(name)}).session);
        simulators.push_back(std::make_unique<test::Simulator>(*sessions.back(), UploadOptions{}));
        simulators.back()->send(0, particles);
    };
    const auto await_turn = [&](std::size_t session) {
        while (sessions[session]->state().wait != SessionWait::device) std::this_thread::yield();
    };
    send(first_id, "ada");
    while (begun == 0) std::this_thread::yield();
    send(second_id, "ada");
    await_turn(1);
    send(third_id, "ada");
    await_turn(2);
    send("00000000-0000-4000-8000-000000000004", "ben");
    await_turn(3);
    gate.release(3);
    while (begun < 4) std::this_thread::yield();
    EXPECT_EQ(sessions[3]->state().frames, 1U) << "it came last, and is the first of its caller";
}

TEST(SharedRegistry, HoldsASharesWorthOfSessionsForEachCaller) {
    SessionRegistry registry{Limits{.sessions = 4, .per_name = {.sessions = 2}},
                             BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
    const auto create = [&](const char* id, const std::string& name, const OwnShares& own = {}) {
        return registry.create(id, test::settings(), {.name = name, .account = registry.account(name, own)}).session;
    };
    const auto first = create(first_id, "ada");
    create(second_id, "ada");
    EXPECT_NO_THROW(create(second_id, "ada")) << "it is there";
    EXPECT_THROW(create(third_id, "ada"), LimitExceeded);
    EXPECT_NO_THROW(create(third_id, "ada", {.sessions = 3})) << "the tokens file may have been changed";
    EXPECT_NO_THROW(create("00000000-0000-4000-8000-000000000004", "ben"));
    registry.remove(first);
    EXPECT_THROW(create(first_id, "ada"), LimitExceeded);
}

TEST(OrphanedRegistry, ForgetsASessionWhoseSimulatorVanishedUnlessItIsWatchedOrResumed) {
    using Clock = std::chrono::steady_clock;
    constexpr auto limit = std::chrono::minutes(2);
    SessionRegistry registry{Limits{.orphan_time = limit}, BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
    const auto later = Clock::now() + 10 * limit;
    const auto open = [](Session& session) { return test::open_upload(session, {.run_id = 7}); };
    const auto vanish = [&](Session& session) { session.cancel_upload(open(session), UploadEnd::vanished); };
    const auto watched = registry.create(first_id, test::settings()).session;
    vanish(*watched);
    const auto watch = watched->open_watch({}, [] {});
    const auto resumed = registry.create(second_id, test::settings()).session;
    vanish(*resumed);
    const auto again = open(*resumed);
    const auto ended = registry.create(third_id, test::settings()).session;
    ended->cancel_upload(open(*ended));
    const auto orphaned = registry.create("00000000-0000-4000-8000-000000000004", test::settings()).session;
    vanish(*orphaned);
    registry.end_idle(Clock::now() + limit / 2);
    EXPECT_EQ(registry.list().size(), 4U);
    while (!orphaned->ended()) registry.end_idle(later);
    EXPECT_EQ(registry.list().size(), 3U);
    watched->close_watch(watch);
    while (!watched->ended()) registry.end_idle(later);
    EXPECT_FALSE(resumed->ended());
    EXPECT_FALSE(ended->ended()) << "that one said goodbye";
}

TEST(OrphanedRegistry, ForgetsASessionThatIsOnlyAskedAbout) {
    using Clock = std::chrono::steady_clock;
    constexpr auto limit = std::chrono::minutes(2);
    SessionRegistry registry{Limits{.idle_time = 10 * limit, .orphan_time = limit},
                             BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
    const auto session = registry.create(first_id, test::settings()).session;
    session->cancel_upload(test::open_upload(*session, {.run_id = 7}), UploadEnd::vanished);
    while (!session->unused(Clock::now() + 2 * limit)) std::this_thread::yield();
    const auto vanished = Clock::now();
    // A call that counts as use from then on.
    while (Clock::now() < vanished + std::chrono::milliseconds(20)) registry.find(first_id);
    while (!session->ended()) registry.end_idle(vanished + limit);
}

TEST(OrphanedRegistry, ForgetsASessionWhoseBrokenStreamLookedFirstAsIfItHadEnded) {
    using Clock = std::chrono::steady_clock;
    constexpr auto limit = std::chrono::minutes(2);
    SessionRegistry registry{Limits{.orphan_time = limit}, BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
    const auto is_left = [&](Session& session) {
        registry.end_idle(Clock::now() + limit + std::chrono::minutes(1));
        return !session.ended();
    };
    const auto open = [](Session& session) { return test::open_upload(session, {.run_id = 7}); };
    const auto wait_for_end = [](Session& session) {
        while (!session.without_stream(Clock::now())) std::this_thread::yield();
    };
    const auto broken = registry.create(first_id, test::settings()).session;
    const auto upload = open(*broken);
    // Its read fails, so that nothing seems to follow; all is answered; then the call proves to be broken.
    broken->end_upload(upload, nullptr);
    wait_for_end(*broken);
    EXPECT_TRUE(is_left(*broken)) << "as if it had said goodbye";
    broken->cancel_upload(upload, UploadEnd::vanished);
    wait_for_end(*broken);
    EXPECT_FALSE(is_left(*broken));

    const auto resumed = registry.create(first_id, test::settings()).session;
    const auto earlier = open(*resumed);
    const auto later = open(*resumed);
    resumed->end_upload(later, nullptr);
    resumed->cancel_upload(later, UploadEnd::answered);
    resumed->cancel_upload(earlier, UploadEnd::vanished);
    wait_for_end(*resumed);
    EXPECT_TRUE(is_left(*resumed)) << "its simulator came back, and ended well";
}

TEST(OrphanedRegistry, ForgetsASessionWhoseSimulatorLeftBeforeItsLastAnswers) {
    constexpr auto limit = std::chrono::minutes(2);
    SessionRegistry registry{Limits{.orphan_time = limit}, BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
    const auto session = registry.create(first_id, test::settings()).session;
    test::Simulator simulator(*session, {.run_id = 7});
    simulator.send(0, test::wave(4, 0.0));
    session->end_upload(simulator.upload, nullptr);
    session->cancel_upload(simulator.upload, UploadEnd::vanished);
    while (!session->ended()) registry.end_idle(std::chrono::steady_clock::now() + 2 * limit);
}

TEST(OrphanedRegistry, ForgetsASessionWhoseSimulatorNeverCameThoughItWasToFollow) {
    using Clock = std::chrono::steady_clock;
    constexpr auto limit = std::chrono::minutes(2);
    SessionRegistry registry{Limits{.orphan_time = limit}, BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
    const auto before = Clock::now();
    const auto create = [&](const char* id, bool stream_follows) {
        return registry.create(id, test::settings(), {}, {.stream_follows = stream_follows}).session;
    };
    const auto stream = [](Session& session) {
        session.cancel_upload(test::open_upload(session), UploadEnd::answered);
    };
    const auto left = create(first_id, true);
    const auto streamed_in_time = create(second_id, true);
    const auto made_to_stay = create(third_id, false);
    const auto watched = create("00000000-0000-4000-8000-000000000004", true);
    const auto watch = watched->open_watch({}, [] {});
    registry.end_idle(before + limit - std::chrono::milliseconds(1));
    EXPECT_EQ(registry.list().size(), 4U);
    stream(*streamed_in_time);
    registry.end_idle(Clock::now() + limit);
    EXPECT_TRUE(left->ended());
    EXPECT_FALSE(streamed_in_time->ended());
    EXPECT_FALSE(made_to_stay->ended());
    EXPECT_FALSE(watched->ended());
    // The stream comes late: its simulator creates the session again.
    const auto late = create(first_id, true);
    EXPECT_NE(late, left);
    stream(*late);
    watched->close_watch(watch);
    registry.end_idle(Clock::now() + 10 * limit);
    EXPECT_FALSE(late->ended());
    EXPECT_TRUE(watched->ended());
}

TEST_F(Registry, RefusesSettingsOutOfRange) {
    EXPECT_THROW(registry.create(first_id, Settings{}), InvalidInput);
    EXPECT_TRUE(registry.list().empty());
}

}  // namespace
}  // namespace meniscus::server
