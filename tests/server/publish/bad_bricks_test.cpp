// What is no surface of the session is refused with its place, its part and the limit; the session lives on.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "dealt_bricks.hpp"
#include "meniscus/error.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

/// A surface of several bricks.
client::ReceivedFrame surface(Codec codec = Codec::lattice_packed) {
    static const Particles particles = wave(12, 0.4);
    LocalSurface local(settings());
    local.reconstruct(particles.view());
    return local.encoded(0, codec);
}

EncodedBrick& changeable(client::ReceivedFrame& frame, std::size_t brick) {
    auto copy = std::make_shared<EncodedBrick>(*frame.bricks.at(brick));
    EncodedBrick& changed = *copy;
    frame.bricks[brick] = std::move(copy);
    return changed;
}

/// What the server says of the frame, by one publisher or by one for each part.
std::string refusal_of(RunningServer& running, const std::vector<client::ReceivedFrame>& parts) {
    const std::string id = running.session();
    std::vector<client::Publisher> publishers;
    const auto count = static_cast<std::uint32_t>(parts.size());
    for (std::uint32_t p = 0; p < count; ++p)
        publishers.push_back(running.client.publish(id, {.parts = count, .part = p, .run = count > 1 ? 0xbeefU : 0U}));
    std::string said = "nothing";
    try {
        for (std::uint32_t p = 0; p < count; ++p) publishers[p].push(parts[p]);
        if (publishers[0].next()) said = "an answer";
    } catch (const InvalidInput& error) {
        said = error.what();
    } catch (const LimitExceeded& error) {
        said = std::string("limit: ") + error.what();
    }
    EXPECT_FALSE(running.client.session(id).frames != 0 && said != "an answer");
    publishers.clear();
    auto again = running.client.publish(id);
    again.push(surface());
    EXPECT_TRUE(again.next()) << "after: " << said;
    running.client.delete_session(id);
    return said;
}

struct BadBricks : testing::Test {
    static ServerOptions options() {
        ServerOptions options = test_options();
        options.limits.check_published = true;
        return options;
    }
    /// change: of a surface that is taken as it is.
    std::string changed(const std::function<void(client::ReceivedFrame&)>& change) {
        client::ReceivedFrame frame = surface();
        change(frame);
        return refusal_of(running, {frame});
    }
    RunningServer running{options()};
};

TEST_F(BadBricks, OfAnotherLatticeAreRefused) {
    EXPECT_EQ(changed([](auto& frame) { frame.cell_size = 0.2; }),
              "frame 0: cell_size is 0.2, and 0.1 with the session's settings: make the surface with these");
    EXPECT_EQ(changed([](auto& frame) { frame.offset_bits = 7; }).substr(0, 25), "frame 0: offset_bits is 7");
}

TEST_F(BadBricks, ThatAreNoneOfTheirCodecAreRefusedWithTheirPlace) {
    const auto place = surface().bricks[1]->coordinate;
    const std::string name =
        "brick (" + std::to_string(place[0]) + ", " + std::to_string(place[1]) + ", " + std::to_string(place[2]) + ")";
    EXPECT_EQ(changed([](auto& frame) { changeable(frame, 1).data.resize(20); }).substr(0, 11 + name.size()),
              "frame 0: " + name + ": ");
    EXPECT_EQ(changed([](auto& frame) { changeable(frame, 1).data.clear(); }),
              "frame 0: " + name + ": its first bytes are not those of a lattice brick of this version");
    EXPECT_EQ(changed([](auto& frame) {
                  EncodedBrick& brick = changeable(frame, 1);
                  for (std::size_t i = 2; i < brick.data.size(); ++i) brick.data[i] = ~brick.data[i];
              }).substr(0, 11 + name.size()),
              "frame 0: " + name + ": ");
    EXPECT_EQ(changed([](auto& frame) { changeable(frame, 1).codec = Codec::lattice_entropy; }),
              "frame 0: " + name + " has the codec entropy, and others of the frame have packed; they have one");
    EXPECT_EQ(changed([](auto& frame) {
                  for (std::size_t i = 0; i < frame.bricks.size(); ++i)
                      changeable(frame, i).codec = Codec::lattice_entropy;
              }).substr(0, 16),
              "frame 0: brick (");
}

TEST_F(BadBricks, OfDracoAreRefusedAsNoOtherCodecCanBeMadeOfThem) {
    const std::string said = refusal_of(running, {surface(Codec::draco)});
    EXPECT_NE(said.find("has the codec draco; publish packed or entropy"), std::string::npos) << said;
}

TEST_F(BadBricks, BeyondTheLatticeAreRefused) {
    const std::string said = changed([](auto& frame) {
        changeable(frame, frame.bricks.size() - 1).coordinate = {0, 0, std::numeric_limits<std::int32_t>::max()};
    });
    EXPECT_EQ(said, "frame 0: brick (0, 0, 2147483647): lies beyond the lattice");
}

TEST_F(BadBricks, ThatComeTwiceAreRefusedWithTheirOwners) {
    EXPECT_NE(changed([](auto& frame) {
                  frame.bricks.push_back(frame.bricks[0]);
                  frame.statistics.triangles += frame.bricks[0]->triangles;
              }).find(" comes twice"),
              std::string::npos);
    std::vector<client::ReceivedFrame> parts = dealt(surface(), 3, 7);
    parts[2].bricks.push_back(parts[1].bricks.at(0));
    parts[2].statistics.triangles += parts[1].bricks[0]->triangles;
    const std::string said = refusal_of(running, parts);
    EXPECT_NE(said.find(" comes from part 1 and from part 2; each brick has one owner"), std::string::npos) << said;
}

TEST_F(BadBricks, AreNotOtherInNumberThanAnnounced) {
    EXPECT_EQ(changed([](auto& frame) { frame.statistics.triangles += 1; }).substr(0, 28),
              "frame 0: the statistics have");
    EXPECT_EQ(changed([](auto& frame) {
                  EncodedBrick& brick = changeable(frame, 0);
                  brick.triangles -= 1;
                  frame.statistics.triangles -= 1;
              }).substr(0, 16),
              "frame 0: brick (");
    EXPECT_EQ(changed([](auto& frame) {
                  std::uint64_t vertices = 0;
                  for (const auto& brick : frame.bricks) vertices += brick->vertices;
                  frame.statistics.vertices = vertices + 1;
              }).substr(0, 28),
              "frame 0: the statistics have");
    EXPECT_EQ(changed([](auto& frame) { changeable(frame, 0).vertices = 100'000'000; }).substr(0, 16),
              "frame 0: brick (");
    EXPECT_EQ(changed([](auto& frame) { frame.statistics.volume = -1.0; }),
              "frame 0: the statistics have volume -1; it must be finite and at least 0");
    EXPECT_EQ(
        changed([](auto& frame) { frame.statistics.stage_seconds[2] = std::numeric_limits<double>::quiet_NaN(); }),
        "frame 0: the statistics have stage_seconds nan; it must be finite and at least 0");
}

TEST_F(BadBricks, WithoutTheirNeighborsAreNoClosedSurface) {
    const client::ReceivedFrame whole = surface();
    ASSERT_GT(whole.bricks.size(), 3U);
    for (std::size_t left_out = 0; left_out < whole.bricks.size(); ++left_out) {
        const std::string said = changed([&](auto& frame) {
            frame.statistics.triangles -= frame.bricks[left_out]->triangles;
            frame.statistics.vertices = 0;
            frame.bricks.erase(frame.bricks.begin() + static_cast<std::ptrdiff_t>(left_out));
        });
        EXPECT_EQ(said.substr(0, 36), "frame 0: the surface is not closed: ") << left_out;
    }
}

TEST(UncheckedBricks, MayMissTheirNeighbors) {
    RunningServer running;
    client::ReceivedFrame frame = surface();
    frame.statistics.triangles -= frame.bricks[0]->triangles;
    frame.statistics.vertices = 0;
    frame.bricks.erase(frame.bricks.begin());
    EXPECT_EQ(refusal_of(running, {frame}), "an answer");
}

}  // namespace
}  // namespace meniscus::server::test
