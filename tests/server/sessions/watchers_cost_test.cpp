// The cost of watchers: the time of their session's simulator, and memory.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <semaphore>
#include <string>
#include <thread>
#include <vector>

#include "meniscus/error.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/limits/limit_reached.hpp"
#include "sessions/session/session.hpp"
#include "simulator_player.hpp"

namespace meniscus::server {
namespace {

using test::id;
using test::Simulator;

constexpr std::chrono::seconds long_enough(10);
constexpr UploadOptions with_meshes{.receive_meshes = true, .normal_bits = 8};

WatchOptions normals(int bits) {
    return {.format = {.position_bits = 6, .normal_bits = bits}};
}

WatchOptions at_most(int max_level) {
    WatchOptions options = normals(8);
    options.format.max_level = max_level;
    return options;
}

/// The index of the next frame that the simulator has an answer to.
std::optional<std::uint64_t> answer(Simulator& simulator) {
    while (const auto response = simulator.receive())
        if (response->has_frame_statistics()) return response->frame_statistics().frame_index();
    return std::nullopt;
}

/// The last message of the next frame of meshes.
SharedMessage last_of_frame(Watch& watch, std::counting_semaphore<>& awake) {
    for (;;) {
        const auto next = watch.take();
        if (const auto* message = std::get_if<SharedMessage>(&next)) {
            v1::WatchResponse response;
            EXPECT_TRUE(response.ParseFromString(**message));
            if (response.has_frame_statistics()) return *message;
        } else if (std::holds_alternative<Watch::End>(next) || !awake.try_acquire_for(long_enough)) {
            ADD_FAILURE() << "no frame came";
            return nullptr;
        }
    }
}

struct WatchersCost : testing::Test {
    std::atomic<int> caps_emitted{0};
    SharedResources shared{.workers = std::make_shared<WorkerPool>(2)};
    Session session{{.id = id},
                    test::settings(),
                    Limits{},
                    {.reconstruct = test::reconstruct_on_the_cpu(),
                     .emit_capped =
                         [this](int /*max_level*/, Mesh& mesh) {
                             ++caps_emitted;
                             Reconstructor reconstructor(test::settings(), {.threads = 1});
                             reconstructor.reconstruct(test::wave(2, 0.0).view(), mesh);
                         }},
                    shared};
    const test::Particles particles = test::wave(4, 0.0);
};

TEST_F(WatchersCost, OfCoarserLevelsIsOneMeshForEachHoweverManyComeAndGoBeforeTheNextFrame) {
    Simulator simulator(session, with_meshes);
    simulator.send(0, particles);
    EXPECT_EQ(answer(simulator), 0U);
    {
        // The device is another session's meanwhile.
        const auto turn = shared.turns->wait({}, "another");
        for (int i = 0; i < 200; ++i)
            for (const int max_level : {1, 2}) session.close_watch(session.open_watch(at_most(max_level), [] {}));
    }
    simulator.send(1, particles);
    EXPECT_EQ(answer(simulator), 1U);
    EXPECT_LE(caps_emitted, 2);
    simulator.end();
}

TEST_F(WatchersCost, IsNoMemoryForFormatsThatNobodyWatchesAnyMore) {
    Simulator simulator(session, with_meshes);
    simulator.send(0, particles);
    EXPECT_EQ(answer(simulator), 0U);
    const auto watched_once = [&](const WatchOptions& options) {
        std::counting_semaphore<> awake{0};
        const auto watch = session.open_watch(options, [&] { awake.release(); });
        std::weak_ptr<const std::string> message = last_of_frame(*watch, awake);
        session.close_watch(watch);
        return message;
    };
    const auto is_freed = [](const std::weak_ptr<const std::string>& message) {
        const auto deadline = std::chrono::steady_clock::now() + long_enough;
        while (!message.expired() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
        return message.expired();
    };
    EXPECT_TRUE(is_freed(watched_once(normals(10))));
    EXPECT_TRUE(is_freed(watched_once(at_most(1))));
    EXPECT_FALSE(watched_once(normals(8)).expired()) << "the stream's own, whose bricks serve its next frame";
    simulator.end();
}

/// Formats whose watchers hold up the encoding, each until the test lets it go on.
struct FormatsThatWait {
    FormatsThatWait(Session& s, int count) : session(s) {
        for (int i = 0; i < count; ++i) {
            watches.push_back(session.open_watch(normals(9 + i), [this, i] {
                {
                    const std::lock_guard lock(mutex);
                    encoded.push_back(i);
                }
                began.release();
                go_on.acquire();
            }));
            EXPECT_TRUE(std::holds_alternative<Watch::Nothing>(watches.back()->take()));
        }
    }
    ~FormatsThatWait() {
        go_on.release(1000);
        session.close();
        session.join();
    }

    Session& session;
    std::counting_semaphore<> began{0};
    std::counting_semaphore<> go_on{0};
    std::mutex mutex;
    std::vector<int> encoded;  ///< in their order
    std::vector<std::shared_ptr<Watch>> watches;
};

TEST_F(WatchersCost, IsOneOfTheirFormatsBetweenTwoFramesAndEachHasItsTurn) {
    Simulator simulator(session, with_meshes);
    FormatsThatWait formats(session, 5);
    for (std::uint64_t i = 0; i < 3; ++i) simulator.send(i, particles);
    for (std::uint64_t turn = 0; turn < 5; ++turn) {
        auto answered = std::async(std::launch::async, [&] { return answer(simulator); });
        const bool in_time = answered.wait_for(long_enough) == std::future_status::ready;
        if (!in_time) formats.go_on.release(1000);
        EXPECT_EQ(answered.get(), turn);
        ASSERT_TRUE(in_time) << "the simulator waits for the watchers";
        ASSERT_TRUE(formats.began.try_acquire_for(long_enough)) << "a format has no turn";
        // There is a slot for it only once the frame that comes after this turn waits to be encoded.
        simulator.send(turn + 3, particles);
        formats.go_on.release();
    }
    simulator.end();
    simulator.receive_all();
    EXPECT_EQ(formats.encoded, (std::vector<int>{0, 1, 2, 3, 4}));
}

/// Goes as soon as it has a frame, and comes again.
struct RestlessWatcher {
    RestlessWatcher(Session& s, const WatchOptions& w) : session(s), options(w) { come(); }
    ~RestlessWatcher() {
        rests = true;
        session.close();
        session.join();
    }
    void come() {
        watch = session.open_watch(options, [this] {
            if (rests) return;
            session.close_watch(watch);
            come();
        });
        EXPECT_FALSE(std::holds_alternative<SharedMessage>(watch->take()));  // the end of the session, perhaps
    }

    Session& session;
    const WatchOptions options;
    std::atomic<bool> rests{false};
    std::shared_ptr<Watch> watch;
};

TEST_F(WatchersCost, IsNoEndlessWorkForOneThatComesAgainAndAgain) {
    Session other({.id = id}, test::settings(), {}, {.reconstruct = test::reconstruct_on_the_cpu()}, shared);
    const auto answers = [&](Session& watched, const WatchOptions& options) {
        Simulator simulator(watched, with_meshes);
        RestlessWatcher watcher(watched, options);
        for (std::uint64_t i = 0; i < 3; ++i) simulator.send(i, particles);
        simulator.end();
        auto answered = std::async(std::launch::async, [&] { return simulator.receive_all(); });
        EXPECT_EQ(answered.wait_for(long_enough), std::future_status::ready);
        watcher.rests = true;
        return answered.get();
    };
    const std::vector<std::uint64_t> all{0, 1, 2};
    EXPECT_EQ(answers(session, normals(10)), all);
    EXPECT_EQ(answers(other, {.format = {}, .max_particles = 10}), all);
}

struct LimitedFormats : testing::Test {
    Session session{{.id = id},
                    test::settings(),
                    {.formats_per_session = 3},
                    {.reconstruct = test::reconstruct_on_the_cpu()},
                    {.workers = std::make_shared<WorkerPool>(1)}};
    const WatchOptions some_particles{.format = {}, .max_particles = 100};

    std::shared_ptr<Watch> watch(const WatchOptions& options, const std::shared_ptr<NameAccount>& name = nullptr) {
        return session.open_watch(
            options, [] {}, name);
    }
    /// Why it is refused; empty: it is not.
    std::string refusal(LimitName limit, const WatchOptions& options,
                        const std::shared_ptr<NameAccount>& name = nullptr) {
        try {
            watch(options, name);
            return "";
        } catch (const LimitReached& error) {
            EXPECT_EQ(error.limit(), limit);
            return error.what();
        }
    }
};

TEST_F(LimitedFormats, RefuseAnotherAndNameThoseInUseWhichMayBeWatchedStill) {
    const auto first = watch(normals(8));
    watch(normals(9));
    watch(some_particles);
    const std::string why = refusal(LimitName::formats, normals(10));
    EXPECT_EQ(
        why.substr(why.find(" have ")),
        " have 3 formats; the server takes at most 3 per session: wish for one of (max_level 3, position_bits 6, "
        "normal_bits 8, codec draco), (max_level 3, position_bits 6, normal_bits 9, codec draco), (max_particles 100)");
    EXPECT_NE(refusal(LimitName::formats, {.format = {}, .max_particles = 101}), "");
    for (const WatchOptions& options : {normals(8), normals(9), some_particles})
        EXPECT_EQ(refusal(LimitName::formats, options), "");
}

TEST_F(LimitedFormats, HaveRoomAgainWhenTheLastWatcherOfOneGoes) {
    const auto first = watch(normals(8));
    watch(normals(9));
    watch(some_particles);
    session.close_watch(first);
    EXPECT_EQ(refusal(LimitName::formats, normals(10)), "");
}

TEST_F(LimitedFormats, OfOneCallerLeaveRoomForOthers) {
    const auto ada = std::make_shared<NameAccount>("ada");
    const auto ben = std::make_shared<NameAccount>("ben");
    for (const auto& name : {ada, ben}) name->set_shares({.formats = 2});
    watch(normals(8), ada);
    watch(normals(9), ada);
    EXPECT_NE(refusal(LimitName::formats_per_name, normals(10), ada).find("the watchers of ada have 2 formats"),
              std::string::npos);
    EXPECT_EQ(refusal(LimitName::formats, normals(10), ben), "");
    EXPECT_EQ(refusal(LimitName::formats, normals(10), ada), "") << "it costs nothing more";
}

}  // namespace
}  // namespace meniscus::server
