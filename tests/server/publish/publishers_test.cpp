// A session of published surfaces is as any other, but for what needs particles.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "dealt_bricks.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_hash.hpp"
#include "running_server.hpp"
#include "test_folder.hpp"

namespace meniscus::server::test {
namespace {

client::ReceivedFrame surface(std::uint64_t index, double phase) {
    LocalSurface local(settings());
    const Particles particles = wave(12, phase);
    local.reconstruct(particles.view());
    return local.encoded(index);
}

template <class Call>
std::string error_of(const Call& call, client::ErrorCode code) {
    try {
        call();
    } catch (const client::ServerError& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        return error.what();
    }
    return "none";
}

struct Publishers : testing::Test {
    RunningServer running;
    std::string id = running.session();

    void publish(client::Publisher& publisher, const client::ReceivedFrame& frame) const {
        publisher.push(frame);
        const auto answer = publisher.next();
        ASSERT_TRUE(answer);
        EXPECT_EQ(answer->index, frame.index);
    }
};

TEST_F(Publishers, SendWatchersTheBricksThatChange) {
    auto publisher = running.client.publish(id);
    for (const Codec codec : {Codec::lattice_packed, Codec::lattice_entropy}) {
        auto watcher = running.client.watch(id, {.codec = codec});
        const std::uint64_t first = codec == Codec::lattice_packed ? 0 : 10;
        client::ReceivedFrame frame = surface(first, 0.1);
        publish(publisher, frame);
        std::optional<client::ReceivedFrame> shown = watcher.next();
        while (shown && shown->index != first) shown = watcher.next();
        ASSERT_TRUE(shown);
        EXPECT_EQ(shown->bricks.size(), frame.bricks.size());
        frame.index = first + 1;
        publish(publisher, frame);
        ASSERT_TRUE(shown = watcher.next());
        EXPECT_TRUE(shown->changed.empty());
        EXPECT_EQ(mesh_sha256(shown->mesh()), mesh_sha256(frame.mesh()));
    }
}

TEST_F(Publishers, TakeMeshesAsTheReconstructorLeavesThem) {
    auto publisher = running.client.publish(id);
    LocalSurface local(settings());
    const Particles particles = wave(8, 0.7);
    local.reconstruct(particles.view());
    publisher.push(local.mesh, local.reconstructor.statistics(), 3, 0.5);
    const auto answer = publisher.next();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->statistics.particles, particles.positions.size() / 3);
    const auto shown = running.client.snapshot(id);
    ASSERT_TRUE(shown);
    EXPECT_EQ(mesh_sha256(shown->mesh()), local_sha256(particles));
    EXPECT_EQ(shown->simulation_time, 0.5);
    Mesh without = local.mesh;
    without.lattice = {};
    EXPECT_THROW(publisher.push(without, {}, 4, 0.0), InvalidInput);
}

TEST_F(Publishers, AreNotMixedWithStreamsOfParticles) {
    {
        auto publisher = running.client.publish(id);
        publish(publisher, surface(0, 0.1));
    }
    const auto of_stream = [&] {
        auto stream = running.client.stream(id);
        stream.next();
    };
    EXPECT_NE(error_of(of_stream, client::ErrorCode::failed_precondition).find("takes frames of bricks"),
              std::string::npos);
    const std::string other = running.session();
    {
        auto stream = running.client.stream(other);
        stream.push(wave(3, 0.0).view(), 0, 0.0);
        EXPECT_TRUE(stream.next());
    }
    const auto of_publisher = [&] {
        auto publisher = running.client.publish(other);
        publisher.next();
    };
    EXPECT_NE(error_of(of_publisher, client::ErrorCode::failed_precondition).find("takes frames of particles"),
              std::string::npos);
}

TEST_F(Publishers, LeaveNothingToWatchersOfParticlesAndOfCappedLevels) {
    auto of_particles = running.client.watch_particles(id);
    auto of_coarse = running.client.watch(id, {.max_level = 1});
    auto publisher = running.client.publish(id);
    publish(publisher, surface(0, 0.1));
    const auto code = client::ErrorCode::failed_precondition;
    EXPECT_NE(error_of([&] { of_particles.next(); }, code).find("it has no particles"), std::string::npos);
    EXPECT_NE(error_of([&] { of_coarse.next(); }, code).find("it has no particles"), std::string::npos);
    const auto late = [&] { running.client.watch(id, {.max_level = 2}).next(); };
    EXPECT_NE(error_of(late, code).find("max_level 1 or 2"), std::string::npos);
}

TEST(RecordedSurfaces, AreTheMeshesThatWerePublished) {
    const TestFolder folder;
    ServerOptions options = test_options();
    options.recording.directory = folder / "recordings";
    RunningServer running(options);
    const std::string id = running.session();
    const std::vector<client::ReceivedFrame> frames{surface(3, 0.1), surface(5, 1.2)};
    {
        auto publisher = running.client.publish(id);
        for (const client::ReceivedFrame& frame : frames) publisher.push(frame);
        publisher.finish();
        while (publisher.next()) {
        }
    }
    running.client.delete_session(id);
    std::vector<client::RecordingInfo> recordings;
    while ((recordings = running.client.recordings()).empty() || recordings.front().being_written)
        std::this_thread::yield();
    EXPECT_EQ(recordings.front().frames, 2U);
    auto reader = running.client.read_recording(id, recordings.front().number);
    for (const client::ReceivedFrame& frame : frames) {
        const auto recorded = reader.next();
        ASSERT_TRUE(recorded);
        EXPECT_EQ(recorded->index, frame.index);
        EXPECT_EQ(mesh_sha256(recorded->mesh()), mesh_sha256(frame.mesh()));
        EXPECT_EQ(recorded->statistics.volume, frame.statistics.volume);
    }
    EXPECT_FALSE(reader.next());
}

TEST_F(Publishers, DropAFrameForAllWhereOneBreaksOff) {
    const auto open = [&](std::uint32_t part) {
        return std::make_unique<client::Publisher>(running.client.publish(id, {.parts = 3, .part = part, .run = 9}));
    };
    std::vector<std::unique_ptr<client::Publisher>> publishers;
    for (std::uint32_t p = 0; p < 3; ++p) publishers.push_back(open(p));
    const auto push = [&](std::uint64_t index, std::size_t from) {
        const std::vector<client::ReceivedFrame> parts = dealt(surface(index, 0.1), 3, 5);
        for (std::size_t p = from; p < 3; ++p) publishers[p]->push(parts[p]);
    };
    push(0, 0);
    for (const auto& publisher : publishers) EXPECT_TRUE(publisher->next());
    push(1, 1);
    publishers[0].reset();
    for (std::size_t p = 1; p < 3; ++p) {
        const auto answers = [&] {
            while (publishers[p]->next()) ADD_FAILURE() << "an answer";
        };
        EXPECT_NE(error_of(answers, client::ErrorCode::aborted).find("part 0 of 3 has broken off"), std::string::npos);
    }
    EXPECT_EQ(running.client.session(id).frames, 1U);
    for (std::uint32_t p = 0; p < 3; ++p) {
        publishers[p].reset();
        publishers[p] = open(p);
    }
    push(1, 0);
    for (const auto& publisher : publishers) EXPECT_TRUE(publisher->next());
    const auto shown = running.client.snapshot(id);
    ASSERT_TRUE(shown);
    EXPECT_EQ(shown->index, 1U);
    EXPECT_EQ(mesh_sha256(shown->mesh()), mesh_sha256(surface(1, 0.1).mesh()));
}

}  // namespace
}  // namespace meniscus::server::test
