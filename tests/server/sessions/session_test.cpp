// The pipeline of a session, driven as its streams and watchers drive it.
#include "sessions/session/session.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <limits>
#include <optional>
#include <semaphore>
#include <thread>
#include <vector>

#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "opened_upload.hpp"
#include "sessions/limits/refusal.hpp"
#include "simulator_player.hpp"
#include "test_frames.hpp"

namespace meniscus::server {
namespace {

using test::id;
using test::reconstruct_on_the_cpu;
using test::Simulator;

WatchOptions normals(int bits) {
    return {.format = {.position_bits = 6, .normal_bits = bits}};
}

/// Plays a watcher.
struct Spectator {
    explicit Spectator(Session& s, const WatchOptions& options = normals(8))
        : session(s), watch(session.open_watch(options, [this] { awake.release(); })) {}
    ~Spectator() { session.close_watch(watch); }

    /// The messages of the next frame, none at the end. That the server goes down is put aside.
    std::vector<SharedMessage> receive() {
        std::vector<SharedMessage> messages;
        for (;;) {
            auto next = watch->take();
            if (const auto* message = std::get_if<SharedMessage>(&next)) {
                v1::WatchResponse response;
                EXPECT_TRUE(response.ParseFromString(**message));
                if (response.has_draining()) {
                    told_of_the_end = true;
                    continue;
                }
                messages.push_back(*message);
                if (response.has_mesh_begin()) triangles = response.mesh_begin().triangle_count();
                if (!response.has_frame_statistics()) continue;
                index = response.frame_statistics().frame_index();
                return messages;
            }
            if (const auto* end = std::get_if<Watch::End>(&next)) {
                error = end->error;
                return {};
            }
            awake.acquire();
        }
    }
    std::uint64_t receive_index() { return receive().empty() ? ~std::uint64_t{0} : index; }

    Session& session;
    std::counting_semaphore<> awake{0};
    std::shared_ptr<Watch> watch;
    std::uint64_t index = 0;      ///< of the last frame received
    std::uint64_t triangles = 0;  ///< of it
    bool told_of_the_end = false;
    std::exception_ptr error;
};

/// A mesh with less in it for a lower cap, whatever the frame.
void emit_capped(int max_level, Mesh& mesh) {
    Reconstructor reconstructor(test::settings(), {.threads = 1});
    reconstructor.reconstruct(test::wave(static_cast<std::size_t>(max_level) + 1, 0.0).view(), mesh);
}

WatchOptions at_most(int max_level) {
    WatchOptions options = normals(8);
    options.format.max_level = max_level;
    return options;
}

struct SessionPipeline : testing::Test {
    Limits limits{.watchers_per_session = 3};
    std::shared_ptr<WorkerPool> workers = std::make_shared<WorkerPool>(2);
    std::atomic<int> caps_emitted{0};
    Session session{{.id = id},
                    test::settings(),
                    limits,
                    {.reconstruct = reconstruct_on_the_cpu(),
                     .emit_capped =
                         [this](int max_level, Mesh& mesh) {
                             ++caps_emitted;
                             emit_capped(max_level, mesh);
                         }},
                    {.workers = workers}};
    const test::Particles particles = test::wave(6, 0.0);
};

TEST_F(SessionPipeline, AnswersEveryFrameInOrder) {
    Simulator simulator(session, {.receive_meshes = true, .normal_bits = 8});
    auto received = std::async(std::launch::async, [&] { return simulator.receive_all(); });
    for (std::uint64_t i = 0; i < 10; ++i) simulator.send(i, test::wave(5, 0.1 * static_cast<double>(i)));
    simulator.end();
    EXPECT_EQ(received.get(), (std::vector<std::uint64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(simulator.error, nullptr);
    EXPECT_EQ(session.state().frames, 10U);
    EXPECT_EQ(session.state().last_frame_index, 9U);
}

TEST_F(SessionPipeline, HasTheFiguresOfAFrameBeforeItsAnswerIsSent) {
    for (const bool receive_meshes : {true, false}) {
        Simulator* simulator = nullptr;
        std::promise<std::optional<std::uint64_t>> figures;
        std::promise<void> ended;
        Simulator player(session, {.receive_meshes = receive_meshes, .normal_bits = 8}, [&] {
            auto next = simulator->upload->output.take();
            for (; const auto* message = std::get_if<SharedMessage>(&next); next = simulator->upload->output.take()) {
                v1::StreamResponse response;
                EXPECT_TRUE(response.ParseFromString(**message));
                if (!response.has_frame_statistics()) continue;
                const std::optional<FrameStatistics> last = session.state().last_frame;
                figures.set_value(last ? std::optional(last->frame_index) : std::nullopt);
            }
            if (std::holds_alternative<OutputQueue::End>(next)) ended.set_value();
        });
        simulator = &player;
        player.upload->output.take();  // there is nothing yet: the next message wakes
        const std::uint64_t frame = receive_meshes ? 3 : 4;
        player.send(frame, particles);
        EXPECT_EQ(figures.get_future().get(), frame);
        player.end();
        ended.get_future().get();
    }
}

TEST(SessionMemory, ThatEncodingTakesCountsAgainstTheLimit) {
    Session session({.id = id}, test::settings(), {.bytes_per_session = 3000},
                    {.reconstruct = reconstruct_on_the_cpu()}, {.workers = std::make_shared<WorkerPool>(2)});
    Simulator simulator(session, {.receive_meshes = true, .normal_bits = 8});
    simulator.send(0, test::wave(6, 0.0));  // 2592 bytes
    EXPECT_TRUE(simulator.receive_all().empty());
    EXPECT_THROW(std::rethrow_exception(simulator.error), LimitExceeded);
    simulator.end();
}

TEST_F(SessionPipeline, LendsNoThirdInputSlot) {
    int lent = 0;
    for (int i = 0; i < 3; ++i)
        session.request_input([&](InputFrame&) {
            ++lent;
            return true;
        });
    EXPECT_EQ(lent, 2);
}

TEST_F(SessionPipeline, AnswersWhatCameBeforeABadFrameAndDropsWhatCameAfter) {
    test::Particles bad = particles;
    bad.positions[4] = std::numeric_limits<float>::quiet_NaN();
    {
        Simulator simulator(session, {.receive_meshes = true, .normal_bits = 8});
        simulator.send(0, particles);
        simulator.send(1, bad);
        simulator.send(2, particles);
        EXPECT_EQ(simulator.receive_all(), (std::vector<std::uint64_t>{0}));
        EXPECT_THROW(std::rethrow_exception(simulator.error), InvalidInput);
        EXPECT_FALSE(session.state().uploading);
        simulator.end();
    }
    Simulator next(session, {.receive_meshes = true, .normal_bits = 8});
    next.send(1, particles);
    next.end();
    EXPECT_EQ(next.receive_all(), (std::vector<std::uint64_t>{1}));
    EXPECT_EQ(next.error, nullptr);
}

TEST_F(SessionPipeline, TakesOneUploadAtATime) {
    const auto upload = test::open_upload(session);
    EXPECT_TRUE(session.state().uploading);
    EXPECT_THROW(test::open_upload(session), Refusal);
    session.end_upload(upload, nullptr);
    EXPECT_NO_THROW(test::open_upload(session));
}

TEST_F(SessionPipeline, SendsStatisticsAloneToWhoWantsNoMeshes) {
    Simulator simulator(session, {.receive_meshes = false, .normal_bits = 0});
    simulator.send(0, particles);
    simulator.end();
    EXPECT_TRUE(simulator.receive()->has_frame_statistics());
    EXPECT_EQ(simulator.receive(), std::nullopt);
}

TEST_F(SessionPipeline, SharesOneEncodeBetweenStreamAndWatchersWithTheSameOptions) {
    Spectator first(session);
    Spectator second(session);
    Spectator other(session, normals(0));
    Simulator simulator(session, {.receive_meshes = true, .normal_bits = 8});
    simulator.send(0, particles);
    const auto frame = first.receive();
    const auto shared = second.receive();
    ASSERT_EQ(frame.size(), shared.size());
    // But for the announcement, which depends on what a watcher has.
    EXPECT_TRUE(std::equal(frame.begin() + 1, frame.end(), shared.begin() + 1));
    EXPECT_NE(frame.back(), other.receive().back());
    simulator.end();
}

TEST_F(SessionPipeline, GivesALateWatcherTheCurrentMeshWhateverItsOptions) {
    Simulator simulator(session, {.receive_meshes = false, .normal_bits = 0});
    simulator.send(3, particles);
    simulator.end();
    simulator.receive_all();
    Spectator watcher(session, normals(10));
    EXPECT_EQ(watcher.receive_index(), 3U);
    Spectator same(session, normals(10));
    EXPECT_EQ(same.receive_index(), 3U);
}

TEST_F(SessionPipeline, GivesALaggingWatcherTheNewestFrame) {
    Spectator watcher(session);
    Simulator simulator(session, {.receive_meshes = false, .normal_bits = 0});
    auto received = std::async(std::launch::async, [&] { return simulator.receive_all(); });
    for (std::uint64_t i = 0; i < 6; ++i) simulator.send(i, particles);
    simulator.end();
    received.get();
    EXPECT_EQ(watcher.receive_index(), 5U);
    EXPECT_EQ(session.state().frames_skipped, 5U);
}

TEST_F(SessionPipeline, EmitsALevelCapOncePerFrameForAllThatAskForItAndOnlyThen) {
    Simulator simulator(session, {.receive_meshes = false, .normal_bits = 0});
    simulator.send(0, particles);
    EXPECT_TRUE(simulator.receive());
    EXPECT_EQ(caps_emitted, 0);
    // Too late for the frame's reconstruction: the surface is emitted once more for the first of the two.
    Spectator first(session, at_most(1));
    EXPECT_EQ(first.receive_index(), 0U);
    EXPECT_EQ(caps_emitted, 1);
    Spectator second(session, at_most(1));
    EXPECT_EQ(second.receive_index(), 0U);
    EXPECT_EQ(second.triangles, first.triangles);
    {
        Spectator other(session, at_most(2));
        EXPECT_EQ(other.receive_index(), 0U);
        EXPECT_GT(other.triangles, first.triangles);
        EXPECT_EQ(caps_emitted, 2);
    }
    simulator.send(1, particles);
    EXPECT_EQ(first.receive_index(), 1U);
    EXPECT_EQ(second.receive_index(), 1U);
    EXPECT_EQ(caps_emitted, 3);
    simulator.end();
}

TEST_F(SessionPipeline, RefusesWatchersPastTheLimit) {
    std::vector<std::shared_ptr<Watch>> watches;
    for (std::uint32_t i = 0; i < limits.watchers_per_session; ++i)
        watches.push_back(session.open_watch(normals(8), [] {}));
    EXPECT_EQ(session.state().watchers, limits.watchers_per_session);
    EXPECT_THROW(session.open_watch(normals(8), [] {}), LimitExceeded);
    session.close_watch(watches.front());
    EXPECT_NO_THROW(session.open_watch(normals(8), [] {}));
}

TEST_F(SessionPipeline, EndsUploadAndWatchersWhenClosedAndSaysWhy) {
    const auto expect_refused = [&](const auto& call) {
        try {
            call();
            ADD_FAILURE() << "it is taken";
        } catch (const Refusal& refusal) {
            EXPECT_EQ(refusal.kind(), Refusal::Kind::not_found);
            EXPECT_EQ(refusal.what(), "session " + session.id() + " has ended: nobody has used it");
        }
    };
    Spectator watcher(session);
    Simulator simulator(session, {.receive_meshes = true, .normal_bits = 8});
    session.close("nobody has used it");
    simulator.receive_all();
    expect_refused([&] { std::rethrow_exception(simulator.error); });
    EXPECT_TRUE(watcher.receive().empty());
    EXPECT_EQ(watcher.error, nullptr);
    EXPECT_EQ(session.end_reason(), "nobody has used it");
    session.close("another reason");
    expect_refused([&] { test::open_upload(session); });
    expect_refused([&] { session.open_watch(normals(8), [] {}); });
}

// Asserts by not hanging: join() returns.
TEST_F(SessionPipeline, ClosesWhileNobodyReads) {
    Simulator simulator(session, {.receive_meshes = true, .normal_bits = 8});
    // The pipeline takes a few frames, then its steps wait for each other, and the next request for a slot for ever.
    for (std::uint64_t i = 0; i < 3; ++i) simulator.send(i, particles);
    session.close();
    session.join();
}

TEST_F(SessionPipeline, EndsWatchersAfterTheLastFrameWhenDrained) {
    Spectator watcher(session);
    Simulator simulator(session, {.receive_meshes = true, .normal_bits = 8});
    simulator.send(0, particles);
    session.drain(std::chrono::seconds(5));
    EXPECT_EQ(simulator.drained, 1);
    simulator.end();
    EXPECT_EQ(simulator.receive_all(), (std::vector<std::uint64_t>{0}));
    EXPECT_EQ(watcher.receive_index(), 0U);
    EXPECT_TRUE(watcher.receive().empty());
    EXPECT_TRUE(watcher.told_of_the_end);
    EXPECT_THROW(std::rethrow_exception(watcher.error), Refusal);
}

TEST_F(SessionPipeline, EndsWatchersAtOnceWhenDrainedWithoutAnUpload) {
    Spectator watcher(session);
    session.drain(std::chrono::seconds(5));
    EXPECT_TRUE(watcher.receive().empty());
    EXPECT_THROW(std::rethrow_exception(watcher.error), Refusal);
}

TEST(SessionOnADevice, AnswersWhatCameBeforeTheDeviceFailedThenEndsItsUploadsAndWatchersWithTheReason) {
    const auto fails_second = [cpu = reconstruct_on_the_cpu(), frames = 0](const ParticleFrame& frame,
                                                                           Mesh& mesh) mutable {
        if (++frames == 2) throw DeviceError("cudaStreamSynchronize", "unspecified launch failure", 1);
        return cpu(frame, mesh);
    };
    Session session({.id = id}, test::settings(), {}, {.reconstruct = fails_second},
                    {.workers = std::make_shared<WorkerPool>(1)});
    const auto particles = test::wave(6, 0.0);
    Spectator watcher(session);
    Simulator simulator(session, {.receive_meshes = true, .normal_bits = 8});
    simulator.send(0, particles);
    simulator.send(1, particles);
    EXPECT_EQ(simulator.receive_all(), (std::vector<std::uint64_t>{0}));
    EXPECT_THROW(std::rethrow_exception(simulator.error), DeviceError);
    while (!watcher.receive().empty()) {
    }
    EXPECT_THROW(std::rethrow_exception(watcher.error), DeviceError);
    EXPECT_TRUE(session.ended());
}

}  // namespace
}  // namespace meniscus::server
