// The mesh is welded and ordered by level, then brick; its table has the places of each brick's triangles.
#include <gtest/gtest.h>

#include <algorithm>

#include "meniscus/meniscus.hpp"
#include "support/mesh_check.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

TEST(MeshOrder, BricksPartitionEveryLevelInOrderAndHoldTheirTriangles) {
    Settings settings = test::default_settings();
    settings.cell_size = 0.25;
    Reconstructor reconstructor(settings, {Backend::cpu, 1, 0});
    Mesh mesh;
    reconstructor.reconstruct(test::splash(51).frame(), mesh);
    ASSERT_GT(mesh.bricks.size(), 8U);
    ASSERT_TRUE(std::is_sorted(mesh.bricks.begin(), mesh.bricks.end(), [](const MeshBrick& a, const MeshBrick& b) {
        return std::lexicographical_compare(a.coordinate.rbegin(), a.coordinate.rend(), b.coordinate.rbegin(),
                                            b.coordinate.rend());
    }));
    std::uint32_t next = 0;
    const std::int32_t edge = brick_cells << mesh.offset_bits;
    for (std::size_t level = 0; level < triangle_level_count; ++level) {
        EXPECT_EQ(mesh.levels[level].first, next);
        EXPECT_GT(mesh.levels[level].count, 0U) << "level " << level;
        for (const MeshBrick& brick : mesh.bricks) {
            EXPECT_EQ(brick.ranges[level].first, next);
            for (std::uint32_t i = 0; i < brick.ranges[level].count; ++i, ++next) {
                EXPECT_EQ(static_cast<std::size_t>(mesh.level_of(next)), level);
                for (const std::uint32_t v : mesh.triangles[next])
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        ASSERT_GE(mesh.vertices[v][axis], brick.coordinate[axis] * edge);
                        ASSERT_LE(mesh.vertices[v][axis], (brick.coordinate[axis] + 1) * edge);
                    }
            }
        }
        EXPECT_EQ(next, mesh.levels[level].first + mesh.levels[level].count);
    }
    EXPECT_EQ(next, mesh.triangles.size());
    const Statistics& statistics = reconstructor.statistics();
    EXPECT_EQ(statistics.triangles, mesh.triangles.size());
    EXPECT_EQ(statistics.vertices, mesh.vertices.size());
}

TEST(MeshOrder, AdaptiveNeedsFewerTrianglesAndSamplesThanUniform) {
    Mesh mesh;
    Settings settings = test::default_settings();
    Reconstructor adaptive(settings, {Backend::cpu, 1, 0});
    adaptive.reconstruct(test::splash(52, 20).frame(), mesh);
    const double adaptive_volume = test::check(mesh).volume;
    settings.mode = Mode::uniform;
    Reconstructor uniform(settings, {Backend::cpu, 1, 0});
    uniform.reconstruct(test::splash(52, 20).frame(), mesh);
    EXPECT_LT(adaptive.statistics().triangles, uniform.statistics().triangles);
    EXPECT_LT(adaptive.statistics().field_evaluations, uniform.statistics().field_evaluations);
    EXPECT_EQ(uniform.statistics().triangles_by_level[2], uniform.statistics().triangles);
    EXPECT_NEAR(adaptive_volume, test::check(mesh).volume, 0.05 * adaptive_volume);
}

TEST(MeshOrder, BisectionAndInterpolationAgreeWithinAFractionOfACell) {
    // Vertices lie on the same edges: in the same order, a fraction of the cell apart.
    Settings settings = test::default_settings();
    Mesh interpolated, bisected;
    Reconstructor a(settings, {Backend::cpu, 1, 0});
    a.reconstruct(test::splash(53).frame(), interpolated);
    settings.edge_points = Bisection{};
    Reconstructor b(settings, {Backend::cpu, 1, 0});
    b.reconstruct(test::splash(53).frame(), bisected);
    ASSERT_EQ(interpolated.vertices.size(), bisected.vertices.size());
    ASSERT_EQ(interpolated.offset_bits, 6U);
    ASSERT_EQ(bisected.offset_bits, 6U);
    EXPECT_TRUE(std::equal(interpolated.triangles.begin(), interpolated.triangles.end(), bisected.triangles.begin(),
                           bisected.triangles.end()));
    double sum = 0.0;
    for (std::size_t v = 0; v < interpolated.vertices.size(); ++v)
        for (std::size_t axis = 0; axis < 3; ++axis)
            sum += std::abs(interpolated.vertices[v][axis] - bisected.vertices[v][axis]);
    EXPECT_LT(sum / static_cast<double>(interpolated.vertices.size()), 3.0);  // of 64 steps
}

}  // namespace
}  // namespace meniscus
