// Boxes of bricks: what processes say of their own adds up to the whole surface, also where each has a halo alone.
#include "meniscus/brick_box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "meniscus/meniscus.hpp"
#include "support/particles.hpp"
#include "support/refusal.hpp"

namespace meniscus {
namespace {

/// All of space in boxes, cut before these coordinates of each axis.
std::vector<BrickBox> boxes_between(const std::array<std::vector<std::int32_t>, 3>& cuts) {
    std::vector<BrickBox> boxes{all_bricks};
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const std::int32_t cut : cuts.at(axis)) {
            std::vector<BrickBox> next;
            for (const BrickBox& box : boxes) {
                if (cut <= box.low.at(axis) || cut >= box.high.at(axis)) {
                    next.push_back(box);
                    continue;
                }
                next.push_back(box);
                next.back().high.at(axis) = cut;
                next.push_back(box);
                next.back().low.at(axis) = cut;
            }
            boxes = std::move(next);
        }
    return boxes;
}

/// Cuts at random between the mesh's bricks, and beyond them.
std::vector<BrickBox> random_boxes(const Mesh& mesh, std::mt19937& random) {
    std::array<std::vector<std::int32_t>, 3> cuts;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::int32_t least = 0, most = 0;
        for (const MeshBrick& brick : mesh.bricks) {
            least = std::min(least, brick.coordinate.at(axis));
            most = std::max(most, brick.coordinate.at(axis));
        }
        std::uniform_int_distribution<std::int32_t> cut(least - 1, most + 2);
        for (int i = 0; i < 2; ++i) cuts.at(axis).push_back(cut(random));
    }
    return boxes_between(cuts);
}

struct Surface {
    Mesh mesh;
    Statistics statistics;
};
Surface surface_of(const Settings& settings, const ParticleFrame& frame) {
    Surface out;
    Reconstructor reconstructor(settings, {Backend::cpu, 1});
    reconstructor.reconstruct(frame, out.mesh);
    out.statistics = reconstructor.statistics();
    return out;
}

Settings many_bricks() {
    Settings settings = test::default_settings();
    settings.cell_size = 0.2;
    return settings;
}

/// The figures of all parts together.
struct Sum {
    std::uint64_t vertices = 0, triangles = 0;
    std::array<std::uint64_t, triangle_level_count> by_level{};
    std::size_t bricks = 0, spray = 0;
    double volume = 0.0;

    void add(const SurfacePart& part) {
        vertices += part.statistics.vertices;
        triangles += part.statistics.triangles;
        for (std::size_t level = 0; level < by_level.size(); ++level)
            by_level.at(level) += part.statistics.triangles_by_level.at(level);
        bricks += part.bricks.size();
        spray += part.spray.size();
        EXPECT_GE(part.statistics.volume, 0.0);
        volume += part.statistics.volume;
    }
    void expect_whole(const Surface& whole) const {
        EXPECT_EQ(vertices, whole.statistics.vertices);
        EXPECT_EQ(triangles, whole.statistics.triangles);
        EXPECT_EQ(by_level, whole.statistics.triangles_by_level);
        EXPECT_EQ(bricks, whole.mesh.bricks.size());
        EXPECT_EQ(spray, whole.mesh.spray.size());
        EXPECT_NEAR(volume, whole.statistics.volume, 1e-12 * whole.statistics.volume);
    }
};

TEST(BrickBoxes, AddUpToTheWholeHoweverSpaceIsCut) {
    std::mt19937 random(1);
    for (unsigned seed = 0; seed < 6; ++seed) {
        Settings settings = many_bricks();
        settings.spray = seed % 2 == 0 ? Spray::points : Spray::keep;
        settings.mode = seed == 5 ? Mode::uniform : Mode::adaptive;
        test::Particles particles = test::splash(seed);
        for (float& x : particles.positions) x -= 0.37F * static_cast<float>(seed);
        const Surface whole = surface_of(settings, particles.frame());
        ASSERT_GT(whole.mesh.bricks.size(), 8U);
        for (int cut = 0; cut < 4; ++cut) {
            Sum sum;
            for (const BrickBox& box : random_boxes(whole.mesh, random))
                sum.add(part_of(whole.mesh, whole.statistics, box));
            sum.expect_whole(whole);
        }
    }
}

TEST(BrickBoxes, OfWaterHaveTheVolumeThatIsInThem) {
    // A block of water from below the box to above it: the box is full.
    test::Particles water;
    for (int z = 0; z < 30; ++z)
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 30; ++x)
                water.add(0.05F * static_cast<float>(x), 0.05F * static_cast<float>(y), 0.05F * static_cast<float>(z));
    const Settings settings = many_bricks();
    const Surface whole = surface_of(settings, water.frame());
    const double edge = brick_cells * world_cell_size(settings);  // 0.32
    const SurfacePart full = part_of(whole.mesh, whole.statistics, {{1, 1, 1}, {3, 2, 3}});
    EXPECT_TRUE(full.bricks.empty());
    EXPECT_NEAR(full.statistics.volume, 4 * edge * edge * edge, 1e-9);
    const SurfacePart upper = part_of(whole.mesh, whole.statistics, {{1, 1, 4}, {2, 2, 5}});
    EXPECT_NEAR(upper.statistics.volume, (1.45 + 0.025 - 4 * edge) * edge * edge, 0.1 * edge * edge * edge);
    EXPECT_EQ(part_of(whole.mesh, whole.statistics, {{1, 1, 9}, {2, 2, 13}}).statistics.volume, 0.0);
}

using Contents = std::map<std::array<std::int32_t, 3>, ContentHash>;

Contents contents_of(const Mesh& mesh, const BrickBox& box) {
    Contents contents;
    for (std::size_t b = 0; b < mesh.bricks.size(); ++b)
        if (box.holds(mesh.bricks[b].coordinate))
            contents.emplace(mesh.bricks[b].coordinate, brick_content(mesh, b).hash());
    return contents;
}

TEST(BrickBoxes, WithAHaloOfParticlesHaveTheBricksOfTheWhole) {
    std::mt19937 random(2);
    for (const Field field : choices<Field>)
        for (const Mode mode : choices<Mode>)
            for (unsigned seed = 0; seed < 2; ++seed) {
                SCOPED_TRACE(std::string(name_of(field)) + " " + std::string(name_of(mode)) + " " +
                             std::to_string(seed));
                Settings settings = test::default_settings();
                settings.field = field;
                settings.mode = mode;
                settings.iso = field == Field::density ? 0.2 : 0.6;
                const test::Particles all = test::splash(70 + seed, 28);
                const Surface whole = surface_of(settings, all.frame());
                const double edge = brick_cells * world_cell_size(settings);
                const double reach = halo(settings) * settings.particle_radius;
                Sum sum;
                Contents contents;
                std::size_t least = all.count();
                for (const BrickBox& box : random_boxes(whole.mesh, random)) {
                    test::Particles mine;
                    for (std::size_t i = 0; i < all.count(); ++i) {
                        bool is_near = true;
                        for (std::size_t axis = 0; axis < 3; ++axis) {
                            const double at = all.positions[3 * i + axis];
                            is_near &= at >= box.low.at(axis) * edge - reach && at <= box.high.at(axis) * edge + reach;
                        }
                        if (is_near) mine.add(all.positions[3 * i], all.positions[3 * i + 1], all.positions[3 * i + 2]);
                    }
                    least = std::min(least, mine.count());
                    const Surface own = surface_of(settings, mine.frame());
                    sum.add(part_of(own.mesh, own.statistics, box));
                    contents.merge(contents_of(own.mesh, box));
                }
                EXPECT_LT(least, all.count());
                EXPECT_EQ(contents, contents_of(whole.mesh, all_bricks));
                sum.expect_whole(whole);
            }
}

TEST(BrickBoxes, HaveTheRangesOfTheirOwnVertices) {
    test::Particles particles = test::splash(3);
    std::vector<float> height;
    for (std::size_t i = 0; i < particles.count(); ++i) height.push_back(particles.positions[3 * i + 2]);
    const ParticleArray array{"height", std::as_bytes(std::span(height))};
    Settings settings = many_bricks();
    settings.attributes = {"height"};
    ParticleFrame frame = particles.frame();
    frame.arrays = std::span(&array, 1);
    const Surface whole = surface_of(settings, frame);
    const SurfacePart lower = part_of(whole.mesh, whole.statistics, {all_bricks.low, {brick_end, brick_end, 1}});
    const SurfacePart upper = part_of(whole.mesh, whole.statistics, {{-brick_end, -brick_end, 1}, all_bricks.high});
    const auto all = attribute_ranges(whole.mesh);
    ASSERT_EQ(lower.ranges.size(), 1U);
    ASSERT_EQ(upper.ranges.size(), 1U);
    EXPECT_LT(lower.ranges[0].maximum[0], upper.ranges[0].maximum[0]);
    EXPECT_GT(upper.ranges[0].minimum[0], lower.ranges[0].minimum[0]);
    EXPECT_EQ(lower.ranges[0].minimum, all[0].minimum);
    EXPECT_EQ(upper.ranges[0].maximum, all[0].maximum);
    EXPECT_TRUE(part_of(whole.mesh, whole.statistics, {{900, 0, 0}, all_bricks.high}).ranges.empty());
}

TEST(BrickBoxes, MayHoldNothing) {
    const Surface none = surface_of(test::default_settings(), {});
    const SurfacePart part = part_of(none.mesh, none.statistics, {{-1, -1, -1}, {2, 2, 2}});
    EXPECT_TRUE(part.bricks.empty());
    EXPECT_EQ(part.statistics.volume, 0.0);
    EXPECT_EQ(part.statistics.vertices, 0U);
}

TEST(BrickBoxes, HoldTheLowestAndTheHighest) {
    constexpr std::int32_t least = std::numeric_limits<std::int32_t>::min();
    constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
    EXPECT_EQ(bricks_between({-1, 0, 2}, {-1, 3, 2}), (BrickBox{{-1, 0, 2}, {0, 4, 3}}));
    EXPECT_EQ(bricks_between({least, least, least}, {most, most, most}), all_bricks);
    EXPECT_FALSE(bricks_between({most - 1, 0, 0}, {most, 0, 0}).holds({brick_end - 1, 0, 0}));
    EXPECT_FALSE(bricks_between({least, 0, 0}, {least, 0, 0}).holds({-brick_end, 0, 0}));
}

TEST(BrickBoxes, AreRefusedWhereTheyEndBeforeTheyBegin) {
    EXPECT_EQ(test::refusal([] {
                  bricks_between({0, 2, 0}, {1, 1, 1});
              }),
              "the box of bricks runs from (0, 2, 0) to (1, 1, 1); the lowest must not be beyond the highest");
}

}  // namespace
}  // namespace meniscus
