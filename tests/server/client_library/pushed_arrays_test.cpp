// Arrays of the particles go up with them, and come back at the vertices.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/canonical_order.hpp"
#include "meniscus/error.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

using client::ParticleBuffer;

Settings with_attributes(std::vector<std::string> names) {
    Settings with = settings();
    with.attributes = std::move(names);
    return with;
}

/// Particles that carry a velocity, which grows along x, and a number each.
struct Carrying {
    Particles particles = wave(7, 0.5);
    std::size_t count = particles.positions.size() / 3;
    std::vector<float> velocities;
    std::vector<std::uint32_t> ids;
    std::vector<ParticleArray> arrays;

    Carrying() {
        for (std::size_t i = 0; i < count; ++i) {
            for (const float v : {particles.positions[3 * i], -0.5F, 2.0F}) velocities.push_back(v);
            ids.push_back(static_cast<std::uint32_t>(0xFFFFFFFFU - i));
        }
        arrays = {{"velocity", std::as_bytes(std::span(velocities)), ElementType::float32, 3},
                  {"id", std::as_bytes(std::span(ids)), ElementType::uint32, 1}};
    }
    ParticleFrame frame() const {
        ParticleFrame view = particles.view();
        view.arrays = arrays;
        return view;
    }
    /// The mesh of these settings, reconstructed in process.
    Mesh mesh(const Settings& settings) const {
        Reconstructor reconstructor(settings, {Backend::cpu, 1, 0});
        Mesh mesh;
        reconstructor.reconstruct(frame(), mesh);
        return in_canonical_order(mesh);
    }
};

void expect_same_attributes(const Mesh& received, const Mesh& expected) {
    const Mesh ordered = in_canonical_order(received);
    ASSERT_EQ(ordered.attributes.size(), expected.attributes.size());
    for (std::size_t i = 0; i < expected.attributes.size(); ++i) {
        EXPECT_EQ(ordered.attributes[i].name, expected.attributes[i].name);
        EXPECT_TRUE(ordered.attributes[i].data == expected.attributes[i].data) << expected.attributes[i].name;
    }
}

class PushedArrays : public testing::Test {
protected:
    client::Session open(const Settings& of) { return running.client.open_session(of); }

    static std::string refusal(client::Stream& stream, const ParticleFrame& frame) {
        try {
            stream.push(frame, 0, 0.0);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return {};
    }

    RunningServer running;
    const Carrying carrying;
    const std::vector<AttributeWish> exactly{{"", 0}};
};

TEST_F(PushedArrays, ComeBackAtTheVerticesHoweverTheyAreHandedOver) {
    const Settings of = with_attributes({"velocity", "id"});
    const Mesh expected = carrying.mesh(of);
    ASSERT_EQ(expected.attributes.size(), 2U);
    client::Session session = open(of);
    client::Stream stream = session.stream({.attributes = exactly});

    stream.push(carrying.frame(), 0, 0.0);
    expect_same_attributes(stream.next()->mesh(), expected);

    stream.push(StridedPositions(carrying.particles.positions.data(), carrying.count, 3 * sizeof(float)), 1, 0.0, {},
                carrying.arrays);
    expect_same_attributes(stream.next()->mesh(), expected);

    ParticleBuffer buffer =
        stream.next_buffer(carrying.count, false, {{"id", ElementType::uint32}, {"velocity", ElementType::float32, 3}});
    std::ranges::copy(carrying.particles.positions, buffer.positions().begin());
    std::ranges::copy(carrying.velocities, buffer.array<float>("velocity").begin());
    std::ranges::copy(carrying.ids, buffer.array<std::uint32_t>("id").begin());
    EXPECT_THROW((void)buffer.array<float>("id"), InvalidInput);
    EXPECT_THROW((void)buffer.array<float>("age"), InvalidInput);
    stream.push(std::move(buffer), 2, 0.0);
    expect_same_attributes(stream.next()->mesh(), expected);

    ParticleBuffer moved(std::vector<float>(carrying.particles.positions));
    moved.add("velocity", std::vector<float>(carrying.velocities), 3);
    moved.add("id", std::vector<std::uint32_t>(carrying.ids));
    ASSERT_TRUE(stream.try_push(std::move(moved), 3, 0.0));
    EXPECT_TRUE(moved.is_taken());  // NOLINT(bugprone-use-after-move): what was moved from says so
    expect_same_attributes(stream.next()->mesh(), expected);
}

TEST_F(PushedArrays, OfASessionWithAllAttributesAreAll) {
    Settings of = settings();
    of.all_attributes = true;
    client::Session session = open(of);
    client::Stream stream = session.stream({.attributes = exactly});
    stream.push(carrying.frame(), 0, 0.0);
    expect_same_attributes(stream.next()->mesh(), carrying.mesh(of));
    Carrying odd;
    odd.arrays[1].name = "Id";
    EXPECT_NE(refusal(stream, odd.frame()).find("an array is named 'Id'"), std::string::npos);
}

TEST_F(PushedArrays, ThatTheSettingsDoNotNameStayHere) {
    const Settings of = with_attributes({"id"});
    client::Session session = open(of);
    Carrying odd;
    odd.arrays[0].components = 2;
    odd.arrays[0].data = odd.arrays[0].data.first(8 * odd.count);
    odd.velocities[0] = std::numeric_limits<float>::quiet_NaN();
    // Through the session, which knows its settings, and by its id alone.
    for (const bool knows : {true, false}) {
        client::Stream stream = knows ? session.stream({.attributes = exactly})
                                      : running.client.stream(session.id(), {.attributes = exactly});
        stream.push(odd.frame(), 0, 0.0);
        expect_same_attributes(stream.next()->mesh(), carrying.mesh(of));
        stream.finish();
        EXPECT_FALSE(stream.next());
    }
}

TEST_F(PushedArrays, AreRefusedByNameBeforeTheyAreSent) {
    client::Session session = open(with_attributes({"velocity", "id"}));
    client::Stream known = session.stream({.attributes = exactly});
    const auto expect_refused = [&](const std::string& words, const auto& change) {
        Carrying odd;
        change(odd);
        const std::string said = refusal(known, odd.frame());
        EXPECT_NE(said.find(words), std::string::npos) << said;
    };
    expect_refused("frame 0: no array 'id'", [](Carrying& c) { c.arrays.pop_back(); });
    expect_refused("frame 0: no array 'velocity'", [](Carrying& c) { c.arrays.clear(); });
    expect_refused("array 'id' comes twice", [](Carrying& c) { c.arrays.push_back(c.arrays[1]); });
    expect_refused("array 'velocity' has",
                   [](Carrying& c) { c.arrays[0].data = c.arrays[0].data.first(c.arrays[0].data.size() - 12); });
    expect_refused("array 'velocity' is float32 of 2 components", [](Carrying& c) {
        c.arrays[0].components = 2;
        c.arrays[0].data = c.arrays[0].data.first(8 * c.count);
    });
    // None of these has ended the stream, nor used the index up.
    known.push(carrying.frame(), 0, 0.0);
    EXPECT_TRUE(known.next());
}

TEST_F(PushedArrays, AreLookedForAtTheServerWhereAStreamHasTheIdAlone) {
    client::Session session = open(with_attributes({"velocity"}));
    client::Stream stream = running.client.stream(session.id(), {.attributes = exactly});
    Carrying odd;
    odd.arrays.erase(odd.arrays.begin());
    EXPECT_NE(refusal(stream, odd.frame()).find("no array 'velocity'"), std::string::npos);
    stream.push(carrying.frame(), 0, 0.0);
    expect_same_attributes(stream.next()->mesh(), carrying.mesh(with_attributes({"velocity"})));
}

TEST_F(PushedArrays, AreSentAgainAfterAConnectionBroke) {
    const ServerOptions options = test_options();
    const Settings of = with_attributes({"velocity", "id"});
    auto first = std::make_unique<RunningServer>(options);
    client::Client client(options.listen);
    const std::string id = client::new_session_id();
    client.create_session(id, of);
    auto resuming = client.stream(id, {.attributes = exactly, .reconnect = std::chrono::seconds(60)});
    first.reset();
    ParticleBuffer buffer(std::vector<float>(carrying.particles.positions));
    buffer.add("id", std::vector<std::uint32_t>(carrying.ids));
    buffer.add("velocity", std::vector<float>(carrying.velocities), 3);
    resuming.push(std::move(buffer), 0, 0.0);
    first = std::make_unique<RunningServer>(options);
    expect_same_attributes(resuming.next()->mesh(), carrying.mesh(of));
}

TEST_F(PushedArrays, ReachWatchersAsTheyAsk) {
    const Settings of = with_attributes({"velocity", "id"});
    client::Session session = open(of);
    client::Watcher exact = session.watch({.attributes = exactly});
    client::Watcher rounded = session.watch({.attributes = {{"velocity", 8}}});
    client::Watcher none = session.watch();
    client::Stream stream = session.stream();
    stream.push(carrying.frame(), 0, 0.0);
    const auto all = exact.next();
    expect_same_attributes(all->mesh(), carrying.mesh(of));
    ASSERT_EQ(all->attributes.size(), 2U);
    const auto ranges = attribute_ranges(carrying.mesh(of));
    EXPECT_EQ(all->attributes[0].range, ranges[0]);
    EXPECT_EQ(all->attributes[1].range, ranges[1]);

    Mesh expected = carrying.mesh(of);
    const std::vector<AttributeWish> asked{{"velocity", 8}};
    round_attributes(expected, asked);
    expect_same_attributes(rounded.next()->mesh(), expected);

    const auto bare = none.next();
    EXPECT_EQ(bare->attributes.size(), 2U);
    EXPECT_TRUE(bare->coded_attributes.empty());
    EXPECT_TRUE(bare->mesh().attributes.empty());
    EXPECT_TRUE(stream.next()->mesh().attributes.empty());

    const auto snapshot = running.client.snapshot(session.id(), {.attributes = exactly});
    expect_same_attributes(snapshot->mesh(), carrying.mesh(of));

    // The surface stays; what it carries does not.
    Carrying moved;
    for (float& v : moved.velocities) v *= 0.5F;
    stream.push(moved.frame(), 1, 0.0);
    const auto next = exact.next();
    EXPECT_EQ(mesh_sha256(next->mesh()), mesh_sha256(all->mesh()));
    EXPECT_FALSE(next->changed.empty());
    expect_same_attributes(next->mesh(), moved.mesh(of));
    EXPECT_TRUE(none.next()->changed.empty());
}

TEST_F(PushedArrays, AttributesOutOfRangeAreRefusedBeforeACall) {
    client::Session session = open(with_attributes({"velocity"}));
    EXPECT_THROW(session.stream({.attributes = {{"velocity", 17}}}), InvalidInput);
    EXPECT_THROW(session.watch({.attributes = {{"velocity", -1}}}), InvalidInput);
    EXPECT_THROW(session.watch({.attributes = {{"velocity", 8}, {"velocity", 8}}}), InvalidInput);
    EXPECT_THROW(running.client.snapshot(session.id(), {.attributes = {{"\xFF", 8}}}), InvalidInput);
}

}  // namespace
}  // namespace meniscus::server::test
