// Snapshots over the wire.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "meniscus/error.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

/// Has answered one frame.
void play(RunningServer& running, const std::string& id, const Particles& particles, std::uint64_t index) {
    auto stream = running.client.stream(id);
    stream.push(particles.view(), index, 0.5);
    stream.finish();
    while (stream.next()) {
    }
}

TEST(Snapshot, IsTheNewestMeshWholeAsAWatcherWithTheSameOptionsReceivesIt) {
    RunningServer running;
    const std::string id = running.session();
    play(running, id, wave(6, 0.0), 4);
    play(running, id, wave(6, 1.0), 5);
    const auto frame = running.client.snapshot(id);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, 5U);
    EXPECT_EQ(frame->simulation_time, 0.5);
    EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(wave(6, 1.0)));
    for (const int level : {1, 2, 3})
        for (const int bits : {2, 6}) {
            const auto snapshot =
                running.client.snapshot(id, {.normal_bits = 4, .position_bits = bits, .max_level = level});
            ASSERT_TRUE(snapshot);
            auto watcher = running.client.watch(id, {.normal_bits = 4, .position_bits = bits, .max_level = level});
            EXPECT_EQ(mesh_sha256(snapshot->mesh()), mesh_sha256(watcher.next()->mesh())) << level << " " << bits;
        }
}

TEST(Snapshot, IsNoneOfASessionWithoutFrames) {
    RunningServer running;
    EXPECT_FALSE(running.client.snapshot(running.session()));
}

TEST(Snapshot, TakesNoWatchersPlaceAndNoFormatOfTheirs) {
    ServerOptions options = test_options();
    options.limits.watchers_per_session = 1;
    options.limits.formats_per_session = 1;
    RunningServer running(options);
    const std::string id = running.session();
    play(running, id, wave(6, 0.0), 0);
    auto watcher = running.client.watch(id, {.normal_bits = 8});
    EXPECT_TRUE(watcher.next());
    EXPECT_TRUE(running.client.snapshot(id, {.normal_bits = 6}));
    EXPECT_EQ(running.client.session(id).watchers, 1U);
    EXPECT_TRUE(running.client.snapshot(id, {.normal_bits = 8}));
}

TEST(Snapshot, IsRefusedPastTheLimitAndNoLongerOnceTheOthersHaveEnded) {
    ServerOptions options = test_options();
    options.limits.snapshots = 1;
    RunningServer running(options);
    const std::string id = running.session();
    const Particles particles = spray(20);  // more than gRPC's buffers hold
    play(running, id, particles, 0);
    const client::Connection connection(running.server.address());
    auto context = std::make_unique<grpc::ClientContext>();
    client::add_session_id(*context, id);
    v1::SnapshotRequest request;
    request.set_session_id(id);
    const auto stalled = connection.surfaces->Snapshot(context.get(), request);
    stalled->WaitForInitialMetadata();
    EXPECT_THROW(running.client.snapshot(id), LimitExceeded);
    context->TryCancel();
    v1::WatchResponse ignored;
    while (stalled->Read(&ignored)) {
    }
    stalled->Finish();
    for (bool refused = true; refused;) {
        try {
            EXPECT_EQ(mesh_sha256(running.client.snapshot(id)->mesh()), local_sha256(particles));
            refused = false;
        } catch (const LimitExceeded&) {
            std::this_thread::yield();  // the server has not noticed yet
        }
    }
}

TEST(Snapshot, OfASessionThatIsDeletedMeanwhileIsWholeOrNotFound) {
    RunningServer running;
    for (int round = 0; round < 10; ++round) {
        const std::string id = running.session();
        play(running, id, wave(6, 0.0), 0);
        std::vector<std::thread> viewers;
        viewers.reserve(4);
        for (int i = 0; i < 4; ++i)
            viewers.emplace_back([&, i] {
                client::Client client(running.server.address());
                try {
                    const auto frame = client.snapshot(id, {.normal_bits = 9 + i});
                    ASSERT_TRUE(frame);
                    EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(wave(6, 0.0)));
                } catch (const client::ServerError& error) {
                    EXPECT_EQ(error.status(), "NOT_FOUND") << error.what();
                }
            });
        running.client.delete_session(id);
        for (std::thread& viewer : viewers) viewer.join();
    }
}

}  // namespace
}  // namespace meniscus::server::test
