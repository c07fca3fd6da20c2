// The promise of a closed 2-manifold does not depend on the field: here it is white noise over random levels.
#include <gtest/gtest.h>

#include "support/mesh_check.hpp"
#include "support/noise.hpp"

namespace meniscus {
namespace {

void expect_closed(const test::NoiseWorld& world, std::uint64_t first, std::uint64_t count_in_suite) {
    const std::uint64_t count = test::noise_worlds(count_in_suite);
    std::size_t triangles = 0;
    std::size_t cracks = 0;
    test::for_each_seed(world, first, count, [&](const test::NoiseWorld& seeded) {
        const Mesh mesh = test::mesh_of_noise_on_cpu(seeded);
        const test::MeshReport report = test::check(mesh);
        ASSERT_TRUE(report.closed_manifold()) << "seed " << seeded.seed << ": " << report.text();
        triangles += mesh.triangles.size();
        cracks += mesh.levels[3].count;
    });
    EXPECT_GT(triangles, 100 * count);
    if (!world.uniform && world.max_level > 1) {
        EXPECT_GT(cracks, 10 * count);
    }
}

TEST(WhiteNoise, GivesClosedManifoldsOverRandomLevels) {
    expect_closed({}, 1, 500);
}
TEST(WhiteNoise, GivesClosedManifoldsWhereSliversAreRaised) {
    expect_closed({.keeps_slivers = false}, 7001, 150);
}
TEST(WhiteNoise, GivesClosedManifoldsWhereFewPointsAreInside) {
    expect_closed({.share = 0.15}, 1001, 150);
}
TEST(WhiteNoise, GivesClosedManifoldsWhereFewPointsAreOutside) {
    expect_closed({.share = 0.85}, 2001, 150);
}
TEST(WhiteNoise, GivesClosedManifoldsWhereValuesLieOnTheIsoValue) {
    expect_closed({.ties = true}, 3001, 100);
}
TEST(WhiteNoise, GivesClosedManifoldsWhenTheBandMustGrow) {
    expect_closed({.share = 0.02, .band_share = 0.1}, 4001, 150);
}
TEST(WhiteNoise, GivesClosedManifoldsWhereLevelsAreCapped) {
    for (const int max_level : {1, 2}) expect_closed({.max_level = max_level}, 8001, 150);
}
TEST(WhiteNoise, GivesClosedManifoldsInUniformMode) {
    expect_closed({.side = 3, .uniform = true}, 5001, 50);
}
TEST(WhiteNoise, GivesClosedManifoldsWithBisection) {
    expect_closed({.bisects = true, .keeps_slivers = false}, 6001, 50);
}

}  // namespace
}  // namespace meniscus
