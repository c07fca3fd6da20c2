// The particles that a surface leaves out come beside it, to receivers that ask.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "conversion/spray_conversion.hpp"
#include "late_meshes.hpp"
#include "meniscus/error.hpp"
#include "sessions/sending/spray_messages.hpp"
#include "sessions/session/session.hpp"
#include "simulator_player.hpp"
#include "test_frames.hpp"

namespace meniscus::server {
namespace {

using test::id;
using test::Simulator;

constexpr UploadOptions with_meshes{.receive_meshes = true, .normal_bits = 8};
constexpr UploadOptions with_spray{.receive_meshes = true, .normal_bits = 8, .spray = true};

/// One point more than a message carries, beginning with this number.
std::vector<Point> points_from(float first) {
    std::vector<Point> points(conversion::max_points_per_message + 1);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = {first + static_cast<float>(i), -0.5F, 1e6F};
    return points;
}

std::vector<v1::WatchResponse> parsed(const std::vector<SharedMessage>& messages) {
    std::vector<v1::WatchResponse> responses(messages.size());
    for (std::size_t i = 0; i < messages.size(); ++i) EXPECT_TRUE(responses[i].ParseFromString(*messages[i]));
    return responses;
}

/// The messages of a frame's spray, as received.
struct Received {
    std::uint64_t announced = 0;
    std::size_t messages = 0;
    std::vector<Point> points;
    bool last_before_the_statistics = true;
};

template <class Next>
Received receive(const Next& next) {
    Received received;
    while (const auto response = next()) {
        if (response->has_mesh_begin()) received.announced = response->mesh_begin().spray_count();
        if (response->has_spray_points()) {
            ++received.messages;
            conversion::append_points(response->spray_points(), received.points);
        }
        if (response->has_mesh_brick() && received.messages != 0) received.last_before_the_statistics = false;
        if (response->has_frame_statistics()) break;
    }
    return received;
}

struct SessionSpray : testing::Test {
    std::unique_ptr<Session> make_session(decltype(ReconstructFunctions::reconstruct) reconstruct) {
        return std::make_unique<Session>(
            SessionIdentity{.id = id}, test::settings(), Limits{},
            ReconstructFunctions{.reconstruct =
                                     [this, made = std::move(reconstruct)](const ParticleFrame& frame, Mesh& mesh) {
                                         Reconstructed result = made(frame, mesh);
                                         mesh.spray.assign(points.begin(), points.end());
                                         return result;
                                     }},
            shared);
    }
    Received next_frame(Simulator& simulator) const {
        return receive([&] { return simulator.receive(); });
    }
    Received next_frame(Watch& watch) const {
        return receive([&]() -> std::optional<v1::WatchResponse> {
            for (;;) {
                const auto next = watch.take();
                if (const auto* message = std::get_if<SharedMessage>(&next)) return parsed({*message}).front();
            }
        });
    }

    std::vector<Point> points = points_from(0.0F);
    SharedResources shared{.workers = std::make_shared<WorkerPool>(1)};
    std::unique_ptr<Session> session = make_session(test::reconstruct_on_the_cpu());
    const test::Particles particles = test::wave(6, 0.0);
};

TEST_F(SessionSpray, ComesBehindTheBricksInMessagesOfLimitedSize) {
    Simulator simulator(*session, with_spray);
    simulator.send(0, particles);
    const Received received = next_frame(simulator);
    EXPECT_EQ(received.announced, points.size());
    EXPECT_EQ(received.messages, 2U);
    EXPECT_EQ(received.points, points);
    EXPECT_TRUE(received.last_before_the_statistics);
}

TEST_F(SessionSpray, ComesToThoseWhoAskAlone) {
    const auto asks = session->open_watch({.format = {.normal_bits = 8}, .spray = true}, [] {});
    const auto asks_not = session->open_watch({.format = {.normal_bits = 8}}, [] {});
    const auto asks_for_a_part = session->open_watch(
        {.format = {.normal_bits = 8}, .region = Box{{100.0, 100.0, 100.0}, {101.0, 101.0, 101.0}}, .spray = true},
        [] {});
    Simulator simulator(*session, with_meshes);
    simulator.send(0, particles);
    const Received streamed = next_frame(simulator);
    EXPECT_EQ(streamed.announced, points.size());
    EXPECT_EQ(streamed.messages, 0U);
    EXPECT_EQ(next_frame(*asks).points, points);
    EXPECT_EQ(next_frame(*asks_not).messages, 0U);
    EXPECT_EQ(next_frame(*asks_for_a_part).points, points) << "all of it, whatever the region";
}

TEST_F(SessionSpray, IsThatOfEachFrameNotADifference) {
    const auto watch = session->open_watch({.format = {.normal_bits = 8}, .spray = true}, [] {});
    Simulator simulator(*session, with_spray);
    for (std::uint64_t frame = 0; frame < 3; ++frame) {
        if (frame == 1) points = {{1.0F, 2.0F, 3.0F}};
        if (frame == 2) points.clear();
        simulator.send(frame, particles);
        EXPECT_EQ(next_frame(simulator).points, points);
        EXPECT_EQ(next_frame(*watch).points, points);
    }
}

TEST_F(SessionSpray, ComesBesideAMeshThatComesDownLate) {
    const auto meshes = std::make_shared<test::LateMeshes>();
    session = make_session(test::reconstruct_late(meshes));
    Simulator simulator(*session, with_spray);
    simulator.send(0, particles);
    EXPECT_EQ(next_frame(simulator).points, points);
    session.reset();
}

TEST(SprayMessages, AreToldFromOthersByTheirFirstByte) {
    for (const SharedMessage& message : spray_messages(points_from(7.0F))) EXPECT_TRUE(is_spray(*message));
    v1::WatchResponse other;
    other.mutable_mesh_begin()->set_spray_count(3);
    EXPECT_FALSE(is_spray(other.SerializeAsString()));
    other.mutable_mesh_brick()->set_x(1);
    EXPECT_FALSE(is_spray(other.SerializeAsString()));
    other.mutable_frame_statistics()->set_frame_index(1);
    EXPECT_FALSE(is_spray(other.SerializeAsString()));
    other.mutable_draining();
    EXPECT_FALSE(is_spray(other.SerializeAsString()));
    EXPECT_FALSE(is_spray(""));
}

TEST(SprayMessages, AreNoneWithoutPoints) {
    EXPECT_TRUE(spray_messages({}).empty());
}

TEST(SprayPoints, AreRefusedUnlessWholeFiniteAndFewEnough) {
    std::vector<Point> points;
    const auto message = [](const std::string& bytes) {
        v1::SprayPoints wire;
        wire.set_positions(bytes);
        return wire;
    };
    for (const std::size_t bytes :
         {std::size_t{0}, std::size_t{11}, std::size_t{13}, 12 * (conversion::max_points_per_message + 1)})
        EXPECT_THROW(conversion::append_points(message(std::string(bytes, '\0')), points), InvalidInput) << bytes;
    for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
        const std::vector<Point> wrong{{0.0F, bad, 0.0F}};
        EXPECT_THROW(conversion::append_points(conversion::to_wire(wrong).at(0), points), InvalidInput) << bad;
    }
}

}  // namespace
}  // namespace meniscus::server
