// The arrays of particles, from a simulator's frame to the vertices of received meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "attribute_frames.hpp"
#include "formats/recordings/recording.hpp"
#include "meniscus/error.hpp"
#include "running_server.hpp"
#include "sample_files.hpp"
#include "tcp_proxy.hpp"
#include "tcp_server.hpp"

namespace meniscus::server::test {
namespace {

std::string session(client::Client& client, const Settings& with) {
    std::string id = client::new_session_id();
    client.create_session(id, with);
    return id;
}

Settings with_all() {
    Settings with = settings();
    with.all_attributes = true;
    return with;
}

/// A stream's meshes carry all attributes, exactly.
client::StreamOptions asking_for(const std::vector<AttributeWish>& attributes) {
    client::StreamOptions options;
    options.attributes = attributes;
    return options;
}

void expect_mesh(const Mesh& received, const ParticlesWithArrays& particles, const Settings& with,
                 const std::vector<AttributeWish>& attributes) {
    const Mesh expected = made_here(particles.view(), with, attributes);
    EXPECT_EQ(mesh_sha256(received), mesh_sha256(expected));
    EXPECT_FALSE(expected.vertices.empty());
    EXPECT_EQ(attributes_of(in_canonical_order(received)), attributes_of(expected));
}

TEST(Attributes, AreThoseOfThisProcessToTheBitForEveryReceiver) {
    RunningServer running;
    const Settings with = settings_with({"velocity", "id", "color"});
    const std::string id = session(running.client, with);
    const ParticlesWithArrays particles(wave(10, 0.3));
    const std::vector<AttributeWish> coarse_velocity{{.name = "velocity", .bits = 5}};
    client::WatchOptions for_all;
    for_all.attributes = all_in_8_bits;
    client::WatchOptions for_one;
    for_one.attributes = coarse_velocity;
    auto all = running.client.watch(id, for_all);
    auto one = running.client.watch(id, for_one);
    auto none = running.client.watch(id);
    auto stream = running.client.stream(id, asking_for(all_exact));
    stream.push(particles.view(), 0, 0.0);
    const auto answer = stream.next();
    ASSERT_TRUE(answer);
    expect_mesh(answer->mesh(), particles, with, all_exact);
    ASSERT_EQ(answer->mesh().attributes.size(), 3U);
    expect_mesh(all.next()->mesh(), particles, with, all_in_8_bits);
    expect_mesh(one.next()->mesh(), particles, with, coarse_velocity);
    expect_mesh(none.next()->mesh(), particles, with, {});
    client::SnapshotOptions snapshot;
    snapshot.attributes = {{.name = "id", .bits = 8}};
    expect_mesh(running.client.snapshot(id, snapshot)->mesh(), particles, with, snapshot.attributes);
}

TEST(Attributes, ThatChangeWhereTheSurfaceRestsReachAWatcherByDifference) {
    RunningServer running;
    const Settings with = settings_with({"velocity"});
    const std::string id = session(running.client, with);
    client::WatchOptions options;
    options.attributes = all_exact;
    auto watcher = running.client.watch(id, options);
    auto stream = running.client.stream(id, asking_for({}));
    for (std::uint64_t frame = 0; frame < 3; ++frame) {
        const ParticlesWithArrays particles(wave(10, 0.0), frame == 2 ? 1.0 : 0.0);
        stream.push(particles.view(), frame, 0.0);
        ASSERT_TRUE(stream.next());
        const auto received = watcher.next();
        ASSERT_TRUE(received);
        expect_mesh(received->mesh(), particles, with, all_exact);
        EXPECT_EQ(received->changed.empty(), frame == 1) << "nothing has changed in the second frame alone";
    }
}

TEST(Attributes, AreAllOfTheFirstFrameWhereTheSettingsSaySo) {
    RunningServer running;
    const std::string id = session(running.client, with_all());
    const ParticlesWithArrays particles(wave(8, 0.0));
    auto stream = running.client.stream(id, asking_for(all_exact));
    stream.push(particles.view(), 0, 0.0);
    const auto answer = stream.next();
    ASSERT_TRUE(answer);
    expect_mesh(answer->mesh(), particles, with_all(), all_exact);
    EXPECT_EQ(answer->mesh().attributes.size(), 3U);
    EXPECT_TRUE(running.client.session(id).settings.all_attributes);
}

TEST(Attributes, ArePartOfTheSettingsThatAJoinerMustHave) {
    RunningServer running;
    const std::string id = session(running.client, settings_with({"velocity", "id"}));
    EXPECT_EQ(running.client.session(id).settings.attributes, (std::vector<std::string>{"velocity", "id"}));
    EXPECT_NO_THROW(running.client.create_session(id, settings_with({"velocity", "id"})));
    for (const Settings& other :
         {settings(), settings_with({"velocity"}), settings_with({"velocity", "age"}), with_all()})
        EXPECT_THROW(running.client.create_session(id, other), std::exception);
}

/// The error that ends the stream for a frame, after one that was good.
std::string refusal_of(RunningServer& running, const std::string& id, const ParticleFrame& frame,
                       const ParticleFrame& good) {
    try {
        auto stream = running.client.stream(id);
        stream.push(good, 1, 0.0);
        EXPECT_TRUE(stream.next());
        stream.push(frame, 2, 0.0);
        stream.finish();
        while (stream.next()) {
        }
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "nothing";
}

TEST(Attributes, ThatCannotBeUsedEndTheirStreamByNameAndNeitherTheSessionNorOtherFrames) {
    RunningServer running;
    const Settings with = settings_with({"velocity"});
    const std::string id = session(running.client, with);
    auto watcher = running.client.watch(id, [] {
        client::WatchOptions options;
        options.attributes = all_exact;
        return options;
    }());
    const ParticlesWithArrays good(wave(8, 0.0));
    ParticlesWithArrays endless(wave(8, 1.0));
    endless.velocity[25] = std::numeric_limits<float>::infinity();
    ParticlesWithArrays scalar(wave(8, 1.0));
    scalar.arrays[1] = {"velocity", std::as_bytes(std::span(scalar.velocity)).first(scalar.velocity.size() / 3 * 4),
                        ElementType::float32, 1};
    for (const ParticlesWithArrays* bad : {&endless, &scalar}) {
        const std::string refusal = refusal_of(running, id, bad->view(), good.view());
        EXPECT_NE(refusal.find("frame 2: "), std::string::npos) << refusal;
        EXPECT_NE(refusal.find("velocity"), std::string::npos) << refusal;
    }
    auto stream = running.client.stream(id);
    stream.push(good.view(), 3, 0.0);
    ASSERT_TRUE(stream.next());
    auto newest = watcher.next();
    while (newest && newest->index != 3) newest = watcher.next();
    ASSERT_TRUE(newest);
    expect_mesh(newest->mesh(), good, with, all_exact);
}

TEST(Attributes, ComeThroughAConnectionThatBreaks) {
    RunningServer running(on_tcp());
    TcpProxy proxy(port_of(running.server.address()));
    client::Client far(proxy.address());
    const Settings with = settings_with({"velocity"});
    const std::string id = session(running.client, with);
    client::StreamOptions options = asking_for(all_exact);
    options.reconnect = std::chrono::milliseconds(60'000);
    auto stream = far.stream(id, options);
    for (std::uint64_t frame = 0; frame < 6; ++frame) {
        const ParticlesWithArrays particles(wave(8, 0.0), static_cast<double>(frame));
        stream.push(particles.view(), frame, 0.0);
        if (frame % 2 == 1) proxy.cut();
        const auto answer = stream.next();
        ASSERT_TRUE(answer);
        EXPECT_EQ(answer->index, frame);
        expect_mesh(answer->mesh(), particles, with, all_exact);
    }
}

TEST(Attributes, AreInRecordingsParticlesAsTheyCameAndMeshesWithTheBitsThatTheServerSays) {
    const meniscus::test::TemporaryDirectory directory;
    const Settings with = settings_with({"velocity", "id"});
    const ParticlesWithArrays particles(wave(8, 0.0));
    ParticlesWithArrays small(quantized(wave(5, 1.0)));
    small.velocity.assign(3 * small.particles.quantized.size() / 3, 0.5F);
    small.id.assign(small.particles.quantized.size() / 3, 3);
    small.arrays = {{"id", std::as_bytes(std::span(small.id)), ElementType::uint32, 1},
                    {"velocity", std::as_bytes(std::span(small.velocity)), ElementType::float32, 3}};
    for (const int bits : {8, 0}) {
        ServerOptions options = test_options();
        options.recording.directory = directory / std::to_string(bits);
        options.recording.attribute_bits = bits;
        std::string id;
        {
            RunningServer running(options);
            id = session(running.client, with);
            auto stream = running.client.stream(id, {.receive_meshes = false});
            stream.push(particles.view(), 0, 0.0);
            stream.push(small.view(), 1, 0.0);
            stream.finish();
            while (stream.next()) {
            }
        }
        const formats::Recording recording(options.recording.directory / id / "000001.recording");
        EXPECT_EQ(recording.settings(), in_force(with));
        ASSERT_EQ(recording.frames().size(), 2U);
        const std::vector<const ParticlesWithArrays*> sent{&particles, &small};
        for (std::size_t i = 0; i < 2; ++i) {
            const formats::RecordedFrame& frame = recording.frames()[i];
            const formats::RecordedParticles recorded = recording.particles(frame);
            EXPECT_EQ(recorded.positions, sent[i]->particles.positions);
            EXPECT_EQ(recorded.quantized, sent[i]->particles.quantized);
            ASSERT_EQ(recorded.arrays.size(), 2U);
            for (const formats::NamedValues& array : recorded.arrays) {
                const auto original = std::ranges::find(sent[i]->arrays, array.name, &ParticleArray::name);
                ASSERT_NE(original, sent[i]->arrays.end());
                EXPECT_TRUE(std::ranges::equal(array.data, original->data));
                EXPECT_EQ(array.type, original->type);
                EXPECT_EQ(array.components, original->components);
            }
            ASSERT_TRUE(frame.mesh);
            expect_mesh(recording.mesh(frame).mesh(), *sent[i], with, {{.name = {}, .bits = bits}});
        }
    }
}

}  // namespace
}  // namespace meniscus::server::test
