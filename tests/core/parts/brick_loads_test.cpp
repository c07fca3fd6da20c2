// What a process has in bricks: particles now, surface in the last frame.
#include "parts/brick_loads.hpp"

#include <gtest/gtest.h>

#include "support/parts.hpp"

namespace meniscus {
namespace {

TEST(BrickLoads, CountTheParticlesOfBricks) {
    const test::Particles particles = test::noise_cube(7, 5000, 0.5, 0.025);
    const Settings settings = test::default_settings();
    std::uint64_t count = 0;
    for (const BrickLoad& load : brick_loads(particles.frame(), settings)) {
        EXPECT_GT(load.particles, 0U);
        count += load.particles;
    }
    EXPECT_EQ(count, particles.count());
}

TEST(BrickLoads, WeighBricksBySomeOfTheirParticles) {
    // In rows of as many as there are in a group, from brick to brick.
    test::Particles particles;
    for (int z = 0; z < 40; ++z)
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x)
                for (const int i : {x, y, z}) particles.positions.push_back(static_cast<float>(i) * 0.1F);
    const Settings settings = test::default_settings();
    const std::vector<BrickLoad> all = brick_loads(particles.frame(), settings);
    const std::vector<BrickLoad> some = brick_loads(particles.frame(), settings, 0, 40);
    std::uint64_t count = 0;
    for (const BrickLoad& load : some) count += load.particles;
    EXPECT_EQ(count, particles.count());
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // Of each layer of bricks.
        for (std::int32_t at = 0; at < 5; ++at) {
            const auto particles_at = [&](const std::vector<BrickLoad>& loads) {
                double sum = 0.0;
                for (const BrickLoad& load : loads) sum += load.brick[axis] == at ? double(load.particles) : 0.0;
                return sum;
            };
            EXPECT_NEAR(particles_at(some), particles_at(all), 0.1 * particles_at(all)) << axis << " " << at;
        }
    }
}

/// In a row along x; the first has 3 triangles, the next 6.
Mesh mesh_of_bricks(std::int32_t count) {
    Mesh mesh;
    for (std::int32_t x = 0; x < count; ++x) {
        MeshBrick brick;
        brick.coordinate = {x, 0, 0};
        brick.ranges[0].count = static_cast<std::uint32_t>(x + 1);
        brick.ranges[3].count = static_cast<std::uint32_t>(2 * x + 2);
        mesh.bricks.push_back(brick);
    }
    return mesh;
}

TEST(BrickLoads, WeighSurfaceByTrianglesAndBricks) {
    const std::vector<BrickLoad> loads = surface_loads(mesh_of_bricks(3), 2, 3);
    ASSERT_EQ(loads.size(), 3U);
    for (std::int32_t x = 0; x < 3; ++x) {
        const auto triangles = static_cast<std::uint32_t>(3 * x + 3);
        EXPECT_EQ(loads[static_cast<std::size_t>(x)], (BrickLoad{{x, 0, 0}, 2, 0, brick_over_triangle + triangles}));
    }
    EXPECT_TRUE(surface_loads({}, 2, 3).empty());
}

TEST(BrickLoads, HaveTheWholeSurfaceInABoundedNumber) {
    for (const std::int32_t bricks : {1, 3, 4, 7, 50})
        for (const std::size_t most : {1U, 3U, 7U}) {
            const std::vector<BrickLoad> loads = surface_loads(mesh_of_bricks(bricks), 0, most);
            EXPECT_LE(loads.size(), most);
            std::uint64_t work = 0;
            for (const BrickLoad& load : loads) {
                EXPECT_GE(load.brick[0], 0);
                EXPECT_LT(load.brick[0], bricks);
                work += load.work();
            }
            const auto count = static_cast<std::uint64_t>(bricks);
            EXPECT_EQ(work, brick_over_triangle * count + 3 * count * (count + 1) / 2);
        }
}

}  // namespace
}  // namespace meniscus
