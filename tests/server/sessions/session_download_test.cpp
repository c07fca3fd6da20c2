// A session whose meshes come down from a device while it goes on with its frames.
#include <gtest/gtest.h>

#include <memory>
#include <semaphore>
#include <string>
#include <thread>
#include <vector>

#include "late_meshes.hpp"
#include "meniscus/error.hpp"
#include "sessions/session/session.hpp"
#include "simulator_player.hpp"
#include "test_frames.hpp"

namespace meniscus::server {
namespace {

using test::id;
using test::Simulator;

constexpr UploadOptions with_meshes{.receive_meshes = true, .normal_bits = 8};

/// The bricks of a frame, as sent.
std::vector<std::string> bricks_of(Simulator& simulator) {
    std::vector<std::string> bricks;
    while (const auto response = simulator.receive()) {
        if (response->has_mesh_brick()) bricks.push_back(response->SerializeAsString());
        if (response->has_frame_statistics()) break;
    }
    return bricks;
}

/// Takes what comes at the session's watch; as much as is there.
std::uint64_t frames_taken(Watch& watch) {
    std::uint64_t frames = 0;
    for (;;) {
        const auto next = watch.take();
        const auto* message = std::get_if<SharedMessage>(&next);
        if (message == nullptr) return frames;
        v1::WatchResponse response;
        EXPECT_TRUE(response.ParseFromString(**message));
        if (response.has_frame_statistics()) ++frames;
    }
}

struct SessionDownload : testing::Test {
    ~SessionDownload() override { meshes->let_go(); }

    std::unique_ptr<Session> make_session() {
        return std::make_unique<Session>(SessionIdentity{.id = id}, test::settings(), Limits{},
                                         ReconstructFunctions{.reconstruct = test::reconstruct_late(meshes)}, shared);
    }
    void wait_for_made(int frames) const {
        while (meshes->made < frames) std::this_thread::yield();
    }

    std::shared_ptr<test::LateMeshes> meshes = std::make_shared<test::LateMeshes>();
    SharedResources shared{.workers = std::make_shared<WorkerPool>(1)};
    std::unique_ptr<Session> session = make_session();
    const test::Particles first = test::wave(12, 0.0);
    const test::Particles second = test::wave(12, 0.5);
};

TEST_F(SessionDownload, TheNextFrameIsReconstructedWhileAMeshComesDownAndBytesStayTheSame) {
    Session on_the_cpu({.id = id}, test::settings(), {}, {.reconstruct = test::reconstruct_on_the_cpu()}, shared);
    Simulator expected(on_the_cpu, with_meshes);
    Simulator simulator(*session, with_meshes);
    meshes->hold();
    for (Simulator* each : {&expected, &simulator}) {
        each->send(0, first);
        each->send(1, second);
    }
    wait_for_made(2);
    meshes->let_go();
    for (int frame = 0; frame < 2; ++frame) {
        const auto bricks = bricks_of(simulator);
        EXPECT_FALSE(bricks.empty());
        EXPECT_EQ(bricks, bricks_of(expected));
    }
}

TEST_F(SessionDownload, TheDevicesTurnEndsWhenTheMeshIsMadeNotWhenItHasComeDown) {
    Session other({.id = id}, test::settings(), {}, {.reconstruct = test::reconstruct_on_the_cpu()},
                  {.workers = std::make_shared<WorkerPool>(1), .turns = shared.turns});
    Simulator simulator(*session, with_meshes);
    Simulator others(other, with_meshes);
    meshes->hold();
    simulator.send(0, first);
    while (meshes->asked_for == 0) std::this_thread::yield();
    others.send(0, second);
    EXPECT_FALSE(bricks_of(others).empty());
    meshes->let_go();
    EXPECT_FALSE(bricks_of(simulator).empty());
}

TEST_F(SessionDownload, ItsTimeIsToldApartFromTheReconstructions) {
    Simulator simulator(*session, with_meshes);
    simulator.send(0, first);
    simulator.end();
    EXPECT_EQ(simulator.receive_all(), (std::vector<std::uint64_t>{0}));
    EXPECT_EQ(session->state().last_frame->download_seconds, 0.25);
}

TEST_F(SessionDownload, AMeshThatNobodyWantsStaysWhereItIsUntilAWatcherComes) {
    Simulator simulator(*session, {});
    for (std::uint64_t i = 0; i < 5; ++i) {
        simulator.send(i, i % 2 == 0 ? first : second);
        while (!simulator.receive()->has_frame_statistics()) {
        }
        EXPECT_LE(meshes->waiting, 2) << "the device has arrays for two";
    }
    EXPECT_EQ(meshes->asked_for, 0);
    std::counting_semaphore<> awake{0};
    const auto watch =
        session->open_watch({.format = {.position_bits = 6, .normal_bits = 8}}, [&] { awake.release(); });
    while (frames_taken(*watch) == 0) awake.acquire();
    EXPECT_EQ(meshes->asked_for, 1);
    session->close_watch(watch);
}

TEST_F(SessionDownload, ADeviceThatFailsMeanwhileEndsTheSessionWithTheReason) {
    Simulator simulator(*session, with_meshes);
    std::counting_semaphore<> awake{0};
    const auto watch =
        session->open_watch({.format = {.position_bits = 6, .normal_bits = 8}}, [&] { awake.release(); });
    meshes->fails = true;
    simulator.send(0, first);
    simulator.send(1, second);
    EXPECT_TRUE(simulator.receive_all().empty());
    EXPECT_THROW(std::rethrow_exception(simulator.error), DeviceError);
    EXPECT_TRUE(session->ended());
    for (;;) {
        const auto next = watch->take();
        if (const auto* end = std::get_if<Watch::End>(&next)) {
            EXPECT_THROW(std::rethrow_exception(end->error), DeviceError);
            break;
        }
        if (std::holds_alternative<SharedMessage>(next)) continue;
        awake.acquire();
    }
}

TEST_F(SessionDownload, ADeviceThatFailsForAWatcherAloneEndsTheSessionToo) {
    Simulator simulator(*session, {});
    const auto watch = session->open_watch({.format = {.position_bits = 6, .normal_bits = 8}}, [] {});
    meshes->fails = true;
    simulator.send(0, first);
    EXPECT_LE(simulator.receive_all().size(), 1U);
    EXPECT_THROW(std::rethrow_exception(simulator.error), DeviceError);
    EXPECT_TRUE(session->ended());
}

TEST_F(SessionDownload, ASessionClosedMeanwhileEndsOnceTheCopyHasEnded) {
    Simulator simulator(*session, with_meshes);
    meshes->hold();
    simulator.send(0, first);
    simulator.send(1, second);
    wait_for_made(2);
    while (meshes->asked_for == 0) std::this_thread::yield();
    session->close();
    EXPECT_TRUE(session->ended());
    meshes->let_go();
    session.reset();
    EXPECT_EQ(meshes->waiting, 0);
}

TEST_F(SessionDownload, AStreamCanceledMeanwhileCostsItsSessionNothing) {
    {
        Simulator simulator(*session, with_meshes);
        meshes->hold();
        simulator.send(0, first);
        while (meshes->asked_for == 0) std::this_thread::yield();
        session->cancel_upload(simulator.upload);
        meshes->let_go();
    }
    Simulator next(*session, with_meshes);
    next.send(0, second);
    next.end();
    EXPECT_EQ(next.receive_all(), (std::vector<std::uint64_t>{0}));
}

}  // namespace
}  // namespace meniscus::server
