// The attributes of a session's meshes: announced to everyone, in the bricks for receivers that ask, by difference.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conversion/attribute_conversion.hpp"
#include "meniscus/error.hpp"
#include "sessions/session/session.hpp"
#include "sessions/watching/canonical_attributes.hpp"
#include "simulator_player.hpp"
#include "test_frames.hpp"

namespace meniscus::server {
namespace {

using test::id;
using test::Simulator;

Settings with_attributes() {
    Settings settings = test::settings();
    settings.attributes = {"speed", "id"};
    return settings;
}

std::vector<AttributeWish> everything(int bits) {
    return {{.name = {}, .bits = bits}};
}

MeshFormat format_of(const std::vector<AttributeWish>& attributes, int max_level = 3) {
    return {.max_level = max_level,
            .position_bits = static_cast<int>(offset_bits(with_attributes())),
            .normal_bits = 8,
            .attributes = canonical_attributes(attributes, with_attributes())};
}

/// One frame as a watcher is sent it.
struct Sent {
    v1::MeshBegin begin;
    std::size_t bricks = 0;
    std::vector<SharedMessage> messages;
};

Sent next_frame(Watch& watch, std::counting_semaphore<>& awake) {
    Sent sent;
    for (;;) {
        const auto next = watch.take();
        if (const auto* message = std::get_if<SharedMessage>(&next)) {
            sent.messages.push_back(*message);
            v1::WatchResponse response;
            EXPECT_TRUE(response.ParseFromString(**message));
            if (response.has_mesh_begin()) sent.begin = response.mesh_begin();
            if (response.has_mesh_brick() && response.mesh_brick().part_index() == 0) ++sent.bricks;
            if (response.has_frame_statistics()) return sent;
        } else {
            awake.acquire();
        }
    }
}

/// Bricks that one vertex lies in, at most: where a corner is common to eight.
constexpr std::size_t most_of_a_vertex = 8;

/// A session whose surface stays, and whose vertices have what the test says.
struct SessionAttributes : testing::Test {
    struct Watcher {
        std::shared_ptr<std::counting_semaphore<>> awake = std::make_shared<std::counting_semaphore<>>(0);
        std::shared_ptr<Watch> watch;
        Sent next() { return next_frame(*watch, *awake); }
    };

    Watcher watcher(const std::vector<AttributeWish>& attributes, int max_level = 3) {
        Watcher made;
        made.watch = session.open_watch({.format = format_of(attributes, max_level)},
                                        [awake = made.awake] { awake->release(); });
        return made;
    }

    void give_attributes(Mesh& mesh) const {
        const std::size_t count = mesh.vertices.size();
        mesh.attributes.clear();
        mesh.attributes.push_back({.name = "speed", .type = ElementType::float32, .components = 1, .data = {}});
        mesh.attributes.push_back({.name = "id", .type = ElementType::uint32, .components = 1, .data = {}});
        for (MeshAttribute& attribute : mesh.attributes) attribute.data.resize(4 * count);
        for (std::size_t i = 0; i < count; ++i) {
            const float value = i == 0 ? first_speed : i == 1 ? top_speed : 0.0F;
            const std::uint32_t number = 7;
            std::memcpy(mesh.attributes[0].data.data() + 4 * i, &value, 4);
            std::memcpy(mesh.attributes[1].data.data() + 4 * i, &number, 4);
        }
    }

    void send(std::uint64_t index) {
        simulator.send(index, particles);
        while (const auto response = simulator.receive())
            if (response->has_frame_statistics()) break;
    }

    float first_speed = 0.0F;
    float top_speed = 1.0F;
    const test::Particles particles = test::spray(7);
    SharedResources shared{.workers = std::make_shared<WorkerPool>(1)};
    std::shared_ptr<Reconstructor> reconstructor =
        std::make_shared<Reconstructor>(test::settings(), BackendOptions{.threads = 2});
    Session session{SessionIdentity{.id = id}, with_attributes(), Limits{},
                    ReconstructFunctions{.reconstruct =
                                             [this](const ParticleFrame& frame, Mesh& mesh) {
                                                 reconstructor->reconstruct(frame, mesh);
                                                 give_attributes(mesh);
                                                 return reconstructor->statistics();
                                             },
                                         .emit_capped =
                                             [this](int max_level, Mesh& mesh) {
                                                 reconstructor->emit_capped(max_level, mesh);
                                                 give_attributes(mesh);
                                             }},
                    shared};
    Simulator simulator{session, {.receive_meshes = true, .normal_bits = 8}};
};

TEST_F(SessionAttributes, AreAnnouncedWithTheirRangesToEveryoneAndCodedForThoseWhoAsk) {
    Watcher none = watcher({});
    Watcher one = watcher({{.name = "speed", .bits = 10}});
    Watcher all = watcher(everything(0), 1);
    send(0);
    for (Watcher* each : {&none, &one, &all}) {
        const v1::MeshBegin begin = each->next().begin;
        ASSERT_EQ(begin.attributes_size(), 2);
        EXPECT_EQ(begin.attributes(0).name(), "speed");
        EXPECT_EQ(begin.attributes(0).type(), v1::ATTRIBUTE_TYPE_FLOAT32);
        EXPECT_EQ(begin.attributes(0).minimum(0), 0.0);
        EXPECT_EQ(begin.attributes(0).maximum(0), 1.0);
        EXPECT_EQ(begin.attributes(1).name(), "id");
        EXPECT_EQ(begin.attributes(1).minimum(0), 7.0);
        EXPECT_EQ(begin.attributes(0).has_bits(), each != &none);
        EXPECT_EQ(begin.attributes(0).bits(), each == &one ? 10U : 0U);
        EXPECT_EQ(begin.attributes(1).has_bits(), each == &all);
    }
}

/// A session of its own for each number of bits: a new watcher is first sent the last frame that there was.
struct ChangingAttributes : SessionAttributes, testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(OfBits, ChangingAttributes, testing::Values(0, 8));

TEST_P(ChangingAttributes, OfABrickWhileTheSurfaceStaysAreSentAgainAndNoOther) {
    Watcher asks = watcher(everything(GetParam()));
    Watcher asks_not = watcher({});
    first_speed = 0.0F;
    send(0);
    const std::size_t whole = asks.next().bricks;
    EXPECT_GT(whole, most_of_a_vertex);
    EXPECT_EQ(asks_not.next().bricks, whole);
    first_speed = 0.75F;
    send(1);
    const Sent changed = asks.next();
    EXPECT_TRUE(changed.begin.has_base_frame_index());
    EXPECT_GE(changed.bricks, 1U);
    EXPECT_LE(changed.bricks, most_of_a_vertex);
    EXPECT_EQ(asks_not.next().bricks, 0U);
    session.close_watch(asks.watch);
    session.close_watch(asks_not.watch);
}

TEST_F(SessionAttributes, AreAllSentAgainWhereTheRangeThatTheyAreCodedOverChanges) {
    Watcher coded = watcher({{.name = "speed", .bits = 8}});
    Watcher exact = watcher({{.name = "speed", .bits = 0}});
    send(0);
    const std::size_t whole = coded.next().bricks;
    EXPECT_EQ(exact.next().bricks, whole);
    top_speed = 100.0F;
    send(1);
    EXPECT_EQ(coded.next().bricks, whole);
    EXPECT_LE(exact.next().bricks, most_of_a_vertex);
}

TEST_F(SessionAttributes, OfEqualOptionsAreEncodedOnce) {
    Watcher first = watcher(everything(8));
    Watcher second = watcher({{.name = "id", .bits = 8}, {.name = "speed", .bits = 8}, {.name = "no_such", .bits = 3}});
    Watcher other = watcher({{.name = "id", .bits = 8}, {.name = "speed", .bits = 9}});
    send(0);
    const Sent one = first.next();
    const Sent two = second.next();
    const Sent three = other.next();
    ASSERT_EQ(one.messages.size(), two.messages.size());
    // The first message is each watcher's own.
    for (std::size_t i = 1; i + 1 < one.messages.size(); ++i) EXPECT_EQ(one.messages[i], two.messages[i]);
    EXPECT_NE(one.messages[1], three.messages[1]);
}

TEST_F(SessionAttributes, ThatTheStreamAsksForComeWithItsMeshes) {
    simulator.end();
    EXPECT_FALSE(simulator.receive());
    Simulator asking(session, {.receive_meshes = true, .normal_bits = 8, .attributes = everything(0)});
    asking.send(0, particles);
    const auto begin = asking.receive();
    ASSERT_TRUE(begin && begin->has_mesh_begin());
    ASSERT_EQ(begin->mesh_begin().attributes_size(), 2);
    EXPECT_TRUE(begin->mesh_begin().attributes(0).has_bits());
    EXPECT_TRUE(begin->mesh_begin().attributes(1).has_bits());
}

TEST_F(SessionAttributes, AreNamedWhereThereAreTooManyFormatsShortlyHoweverManyTheyAre) {
    Settings many = test::settings();
    for (int i = 0; i < 16; ++i) many.attributes.push_back("a" + std::to_string(10 + i) + std::string(61, 'x'));
    Session limited(SessionIdentity{.id = id}, many, Limits{.formats_per_session = 8}, ReconstructFunctions{}, shared);
    std::vector<std::shared_ptr<Watch>> watches;
    const auto watch = [&](int bits) {
        watches.push_back(
            limited.open_watch({.format = {.attributes = canonical_attributes(everything(bits), many)}}, [] {}));
    };
    for (int bits = 0; bits < 8; ++bits) watch(bits);
    try {
        watch(9);
        FAIL();
    } catch (const LimitExceeded& error) {
        const std::string text = error.what();
        EXPECT_LT(text.size(), 4096U);
        EXPECT_NE(text.find(", attributes " + many.attributes[0] + " of 7 bits and "), std::string::npos) << text;
        EXPECT_NE(text.find(" and 12 more)"), std::string::npos) << text;
    }
}

TEST(CanonicalAttributes, AreEqualForListsThatComeToTheSame) {
    const Settings settings = with_attributes();
    const std::vector<AttributeWish> both{{"id", 8}, {"speed", 8}};
    EXPECT_EQ(canonical_attributes(everything(8), settings), both);
    EXPECT_EQ(canonical_attributes({{"speed", 8}, {"id", 8}, {"other", 1}}, settings), both);
    EXPECT_EQ(canonical_attributes({{"speed", 8}, {"", 8}}, settings), both);
    EXPECT_EQ(canonical_attributes({{"speed", 3}, {"", 8}}, settings),
              (std::vector<AttributeWish>{{"id", 8}, {"speed", 3}}));
    EXPECT_EQ(canonical_attributes({{"other", 8}}, settings), std::vector<AttributeWish>{});
    EXPECT_EQ(canonical_attributes(everything(8), test::settings()), std::vector<AttributeWish>{});
    Settings all = test::settings();
    all.all_attributes = true;
    EXPECT_EQ(canonical_attributes({{"speed", 3}, {"", 8}}, all), (std::vector<AttributeWish>{{"", 8}, {"speed", 3}}));
}

}  // namespace
}  // namespace meniscus::server
