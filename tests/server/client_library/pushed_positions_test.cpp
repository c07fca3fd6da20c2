// Positions as solvers have them: moved in, written in place, in float64, within larger records.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/error.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

using client::ParticleBuffer;

/// A particle's record, as a solver may have it.
struct Record {
    double density;
    double place[3];
    float mass;
};

std::vector<double> float64(const std::vector<float>& positions) {
    std::vector<double> result(positions.size());
    // Less than half a unit in the last place away.
    std::transform(positions.begin(), positions.end(), result.begin(),
                   [](float p) { return static_cast<double>(p) * (1.0 + 0x1p-26); });
    return result;
}

class PushedPositions : public testing::Test {
protected:
    std::string next_hash() {
        const auto frame = stream.next();
        return frame ? mesh_sha256(frame->mesh()) : "";
    }
    /// The message of push() for positions that it refuses; the stream may be used on.
    template <class... Frame>
    std::string refusal(Frame&&... frame) {
        try {
            stream.push(std::forward<Frame>(frame)...);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "accepted";
    }

    RunningServer running;
    client::Stream stream = running.client.stream(running.session());
    const Particles particles = wave(9, 0.5);
    const std::string expected = local_sha256(particles);
};

TEST_F(PushedPositions, GiveTheSameMeshHoweverTheyAreHandedOver) {
    stream.push(particles.view(), 0, 0.0);
    EXPECT_EQ(next_hash(), expected);

    stream.push(std::vector<float>(particles.positions), 1, 0.0);
    EXPECT_EQ(next_hash(), expected) << "a vector that is moved in";

    ParticleBuffer buffer = stream.next_buffer(particles.positions.size() / 3);
    ASSERT_EQ(buffer.positions().size(), particles.positions.size());
    std::copy(particles.positions.begin(), particles.positions.end(), buffer.positions().begin());
    stream.push(std::move(buffer), 2, 0.0);
    EXPECT_EQ(next_hash(), expected) << "written in place";

    const std::vector<double> doubles = float64(particles.positions);
    stream.push(StridedPositions(doubles), 3, 0.0);
    EXPECT_EQ(next_hash(), expected) << "float64";

    std::vector<Record> records(doubles.size() / 3);
    for (std::size_t i = 0; i < records.size(); ++i) std::memcpy(records[i].place, &doubles[3 * i], sizeof(double[3]));
    stream.push({records[0].place, records.size(), sizeof(Record)}, 4, 0.0);
    EXPECT_EQ(next_hash(), expected) << "within records";
}

TEST_F(PushedPositions, BringTheirLevelsWithThem) {
    Particles coarse = particles;
    coarse.levels.assign(particles.positions.size() / 3, 0);
    for (std::size_t i = 0; i < coarse.levels.size(); i += 7) coarse.levels[i] = 1;
    const std::string with_levels = local_sha256(coarse);
    ASSERT_NE(with_levels, expected);

    stream.push(ParticleBuffer(std::vector<float>(coarse.positions), std::vector<std::uint8_t>(coarse.levels)), 0, 0.0);
    EXPECT_EQ(next_hash(), with_levels);

    ParticleBuffer buffer = stream.next_buffer(coarse.levels.size(), true);
    std::copy(coarse.positions.begin(), coarse.positions.end(), buffer.positions().begin());
    std::copy(coarse.levels.begin(), coarse.levels.end(), buffer.levels().begin());
    stream.push(std::move(buffer), 1, 0.0);
    EXPECT_EQ(next_hash(), with_levels);

    stream.push(StridedPositions(float64(coarse.positions)), 2, 0.0, coarse.levels);
    EXPECT_EQ(next_hash(), with_levels);
}

TEST_F(PushedPositions, ArriveWholeWhereTheyTakeManyMessages) {
    const Particles many = wave(46, 0.0);  // 1.2 MB; a message has 1 MiB at most
    Particles with_levels = many;
    with_levels.levels.assign(many.positions.size() / 3, 0);
    stream.push(ParticleBuffer(std::vector<float>(many.positions), std::vector<std::uint8_t>(with_levels.levels)), 0,
                0.0);
    EXPECT_EQ(next_hash(), local_sha256(with_levels));
}

TEST_F(PushedPositions, AreSentAgainFromTheMemoryThatWasTakenOver) {
    const ServerOptions options = test_options();
    auto first = std::make_unique<RunningServer>(options);
    client::Client client(options.listen);
    auto resuming = client.stream(first->session(), {.reconnect = std::chrono::seconds(60)});
    first.reset();
    resuming.push(std::vector<float>(particles.positions), 0, 0.0);
    first = std::make_unique<RunningServer>(options);
    EXPECT_EQ(mesh_sha256(resuming.next()->mesh()), expected);
}

TEST_F(PushedPositions, AreRefusedWithTheirPlaceAndValueWhereFloat32CannotHoldThem) {
    std::vector<double> doubles = float64(particles.positions);
    doubles[3 * 5 + 1] = 1e39;
    const std::string large = refusal(StridedPositions(doubles), 0U, 0.0);
    EXPECT_NE(large.find("particle 5 has y = 1e+39, which float32 cannot hold"), std::string::npos) << large;
    doubles[3 * 5 + 1] = std::numeric_limits<double>::quiet_NaN();
    const std::string none = refusal(StridedPositions(doubles), 0U, 0.0);
    EXPECT_NE(none.find("particle 5 has y = nan, positions must be finite"), std::string::npos) << none;
    std::vector<float> floats = particles.positions;
    floats[3 * 5 + 1] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(refusal(StridedPositions(floats), 0U, 0.0), none);
    stream.push(particles.view(), 0, 0.0);
    EXPECT_EQ(next_hash(), expected);
}

TEST_F(PushedPositions, AreRefusedWithTheirNumbersWhereLengthsDoNotFit) {
    const std::vector<float> seven(7);
    const std::vector<std::uint8_t> two(2);
    ParticleFrame frame;
    frame.positions = seven;
    EXPECT_EQ(refusal(frame, 0U, 0.0), "the frame has 7 coordinates, must be three per particle");
    EXPECT_EQ(refusal(ParticleBuffer(std::vector<float>(7)), 0U, 0.0),
              "the frame has 7 coordinates, must be three per particle");
    const std::string levels = "the frame has 2 levels for 3 particles, must have one each or none";
    EXPECT_EQ(refusal(ParticleBuffer(std::vector<float>(9), std::vector<std::uint8_t>(2)), 0U, 0.0), levels);
    EXPECT_EQ(refusal(StridedPositions(std::vector<double>(9)), 0U, 0.0, two), levels);
    stream.push(particles.view(), 0, 0.0);
    EXPECT_EQ(next_hash(), expected);
}

TEST_F(PushedPositions, AreRefusedOutOfABufferThatWasPushedBefore) {
    ParticleBuffer buffer = stream.next_buffer(particles.positions.size() / 3);
    std::copy(particles.positions.begin(), particles.positions.end(), buffer.positions().begin());
    stream.push(std::move(buffer), 0, 0.0);
    EXPECT_EQ(next_hash(), expected);
    EXPECT_TRUE(buffer.is_taken());  // NOLINT(bugprone-use-after-move): what was moved from says so
    EXPECT_TRUE(buffer.positions().empty());
    EXPECT_NE(refusal(std::move(buffer), 1U, 0.0).find("was pushed or moved from before"), std::string::npos);
}

TEST_F(PushedPositions, MayBeNone) {
    stream.push(std::vector<float>(), 0, 0.0);
    EXPECT_EQ(stream.next()->bricks.size(), 0U);
    stream.push(stream.next_buffer(0), 1, 0.0);
    EXPECT_EQ(stream.next()->bricks.size(), 0U);
    stream.push({static_cast<const double*>(nullptr), 0}, 2, 0.0);
    EXPECT_EQ(stream.next()->bricks.size(), 0U);
    EXPECT_THROW(stream.next_buffer(std::size_t{1} << 62), LimitExceeded);
}

}  // namespace
}  // namespace meniscus::server::test
