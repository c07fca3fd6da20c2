#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meniscus/error.hpp"
#include "meniscus/names.hpp"
#include "simulator/adaptive_levels.hpp"
#include "simulator/kernel.hpp"
#include "simulator/simulation.hpp"

namespace meniscus::simulator {
namespace {

constexpr double frame_seconds = 0.02;

/// Checks that every particle is finite and in the tank.
void expect_inside(const Simulation& simulation) {
    const Vector3 size = simulation.scene().tank.size;
    const std::vector<float> p = simulation.positions();
    for (std::size_t i = 0; i < p.size(); ++i) {
        ASSERT_TRUE(std::isfinite(p[i]));
        ASSERT_GE(p[i], 0.0F);
        ASSERT_LE(p[i], size[i % 3]);
    }
}

double mean(const std::vector<float>& positions, std::size_t axis) {
    double sum = 0.0;
    for (std::size_t i = axis; i < positions.size(); i += 3) sum += static_cast<double>(positions[i]);
    return sum / (static_cast<double>(positions.size()) / 3.0);
}

TEST(CubicSpline, IntegratesToItsMassAndSlopesAsItFalls) {
    const CubicSpline kernel(2.0F, 3.0F);
    double integral = 0.0;
    constexpr int steps = 2000;
    for (int i = 0; i < steps; ++i) {
        const double r = (i + 0.5) * 2.0 / steps;
        integral +=
            4.0 * std::numbers::pi * r * r * static_cast<double>(kernel.value(static_cast<float>(r))) * 2.0 / steps;
    }
    EXPECT_NEAR(integral, 3.0, 1e-3);
    for (const float r : {0.2F, 0.9F, 1.1F, 1.7F})
        EXPECT_NEAR(kernel.slope(r), (kernel.value(r + 1e-2F) - kernel.value(r - 1e-2F)) / 2e-2F, 2e-3F);
    EXPECT_EQ(kernel.value(2.5F), 0.0F);
}

TEST(Simulation, KnowsHowFastItsParticlesMoveAndHowOldTheyAre) {
    Simulation simulation(make_scene(SceneKind::pour_on_obstacle, 2000));
    double time = 0.0;
    do {
        simulation.advance(frame_seconds);
        time += frame_seconds;
    } while (time < 1.0 && simulation.ages().front() == simulation.ages().back());
    const std::vector<float> before = simulation.positions();
    EXPECT_EQ(simulation.ages().size(), before.size() / 3);
    EXPECT_EQ(simulation.velocities().size(), before.size());
    constexpr double moment = 1e-4;
    simulation.advance(moment);
    const std::vector<float> after = simulation.positions();
    const std::vector<float> velocities = simulation.velocities();
    const std::vector<float> ages = simulation.ages();
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_NEAR(static_cast<double>(after[i] - before[i]) / moment, static_cast<double>(velocities[i]), 0.05);
    EXPECT_NEAR(ages.front(), time + moment, 1e-4);
    EXPECT_TRUE(std::is_sorted(ages.rbegin(), ages.rend())) << "particles are in the order in which they came in";
    EXPECT_LT(ages.back(), ages.front());
    EXPECT_GE(ages.back(), 0.0F);
}

TEST(MergeDeepParticles, GivesMergedParticlesTheMeanOfWhatTheyCarried) {
    const Simulation simulation(make_scene(SceneKind::dam_break, 4000));
    const std::vector<float> positions = simulation.positions();
    const LeveledParticles leveled =
        merge_deep_particles(positions, simulation.scene().particle_radius, simulation.scene().tank);
    ASSERT_NE(std::count(leveled.levels.begin(), leveled.levels.end(), 1), 0);
    EXPECT_EQ(leveled.merged(positions, 3), leveled.positions) << "a mean of places is where the particle is";
    const LeveledParticles uniform{.positions = positions};
    EXPECT_EQ(uniform.merged(positions, 3), positions);
}

TEST(Boundary, ActsLikeFluidBehindTheWall) {
    const Boundary boundary({{10.0F, 10.0F, 10.0F}}, std::nullopt, 1.0F);
    EXPECT_EQ(boundary.density({5.0F, 5.0F, 5.0F}).value, 0.0F);
    const BoundaryDensity at_wall = boundary.density({0.0F, 5.0F, 5.0F});
    EXPECT_NEAR(at_wall.value, 0.5F, 2e-3F);
    EXPECT_LT(at_wall.gradient[0], 0.0F);
    EXPECT_EQ(at_wall.gradient[1], 0.0F);
    EXPECT_NEAR(boundary.density({0.0F, 0.0F, 5.0F}).value, 0.75F, 2e-3F);
    EXPECT_NEAR(boundary.density({0.0F, 10.0F, 0.0F}).value, 0.875F, 2e-3F);
}

TEST(Boundary, ObstacleRepelsRadially) {
    const Boundary boundary({{10.0F, 10.0F, 10.0F}}, Sphere{{5.0F, 5.0F, 5.0F}, 2.0F}, 1.0F);
    const BoundaryDensity above = boundary.density({5.0F, 7.1F, 5.0F});
    EXPECT_GT(above.value, 0.0F);
    EXPECT_LT(above.gradient[1], 0.0F);
    Vector3 position{5.0F, 6.0F, 5.0F};
    Vector3 velocity{1.0F, -1.0F, 0.0F};
    boundary.keep_out(position, velocity, 0.1F);
    EXPECT_NEAR(position[1], 7.1F, 1e-5F);
    EXPECT_NEAR(velocity[1], 0.0F, 1e-6F);
    EXPECT_EQ(velocity[0], 1.0F);
}

TEST(Scene, DamBreakTankIsThePapersGrid) {
    const Scene scene = make_scene(SceneKind::dam_break, 16000);
    EXPECT_EQ(scene.particles.size(), 16000U);
    const float base_cell = 2.0F * scene.particle_radius;  // four finest cells of half a radius
    EXPECT_NEAR(scene.tank.size[0] / base_cell, 81.0F, 1e-3F);
    EXPECT_NEAR(scene.tank.size[1] / base_cell, 43.0F, 1e-3F);
    EXPECT_NEAR(scene.tank.size[2] / base_cell, 43.0F, 1e-3F);
    for (const Vector3& p : scene.particles)
        for (std::size_t a = 0; a < 3; ++a) {
            ASSERT_GE(p[a], 0.99F * scene.particle_radius);
            ASSERT_LE(p[a], scene.tank.size[a] - 0.99F * scene.particle_radius);
        }
}

TEST(Scene, RefusesNumbersOfParticlesOutOfRange) {
    EXPECT_THROW(make_scene(SceneKind::dam_break, 0), InvalidInput);
    EXPECT_THROW(make_scene(SceneKind::dam_break, 200'000'000), InvalidInput);
    EXPECT_THROW(::meniscus::by_name<SceneKind>("tsunami", "scene"), InvalidInput);
}

TEST(Simulation, DamBreakCollapsesAndRunsUpTheOppositeWall) {
    Simulation simulation(make_scene(SceneKind::dam_break, 3000));
    const Vector3 size = simulation.scene().tank.size;
    const double energy = simulation.solver().energy();
    const double height = mean(simulation.positions(), 1);
    float highest_at_wall = 0.0F;
    for (int frame = 0; frame < 75; ++frame) {
        simulation.advance(frame_seconds);
        ASSERT_EQ(simulation.solver().count(), 3000U);
        expect_inside(simulation);
        ASSERT_LT(simulation.solver().energy(), 1.1 * energy) << "frame " << frame;
        const std::vector<float> p = simulation.positions();
        for (std::size_t i = 0; i < p.size(); i += 3)
            if (p[i] > 0.95F * size[0]) highest_at_wall = std::max(highest_at_wall, p[i + 1]);
    }
    EXPECT_LT(mean(simulation.positions(), 1), 0.8 * height);
    EXPECT_GT(highest_at_wall, 0.4F * size[1]);
    EXPECT_NEAR(simulation.time(), 75 * frame_seconds, 1e-5);
}

TEST(Simulation, DoubleDamBreakStaysSymmetricOnAverage) {
    Simulation simulation(make_scene(SceneKind::double_dam_break, 2000));
    for (int frame = 0; frame < 30; ++frame) simulation.advance(frame_seconds);
    expect_inside(simulation);
    const float width = simulation.scene().tank.size[0];
    EXPECT_NEAR(mean(simulation.positions(), 0), 0.5 * static_cast<double>(width), 0.05 * static_cast<double>(width));
}

TEST(Simulation, PouredWaterSettlesAroundTheObstacle) {
    Simulation simulation(make_scene(SceneKind::pour_on_obstacle, 1000));
    std::size_t before = 0;
    for (int frame = 0; frame < 200; ++frame) {
        simulation.advance(frame_seconds);
        ASSERT_GE(simulation.solver().count(), before);
        before = simulation.solver().count();
        expect_inside(simulation);
    }
    EXPECT_EQ(before, 1000U);
    const Sphere obstacle = *simulation.scene().obstacle;
    const std::vector<float> p = simulation.positions();
    for (std::size_t i = 0; i < p.size(); i += 3) {
        const Vector3 d{p[i] - obstacle.center[0], p[i + 1] - obstacle.center[1], p[i + 2] - obstacle.center[2]};
        EXPECT_GE(std::sqrt(dot(d, d)), obstacle.radius);
    }
    EXPECT_LT(mean(p, 1), static_cast<double>(obstacle.center[1]));
}

TEST(Simulation, RepeatsBitForBit) {
    Simulation a(make_scene(SceneKind::dam_break, 1500));
    Simulation b(make_scene(SceneKind::dam_break, 1500));
    for (int frame = 0; frame < 10; ++frame) {
        a.advance(frame_seconds);
        b.advance(frame_seconds);
    }
    EXPECT_EQ(a.positions(), b.positions());
}

TEST(Solver, WaterAtRestStaysAtRest) {
    // A pool over the whole ground: 10 x 5 x 10 particles at rest distance.
    Scene scene;
    scene.particle_radius = 0.05F;
    scene.tank.size = {1.0F, 2.0F, 1.0F};
    for (int i = 0; i < 500; ++i) {
        const int layer = i / 100;
        const int row = i / 10 % 10;
        scene.particles.push_back({0.05F + 0.1F * static_cast<float>(i % 10), 0.05F + 0.1F * static_cast<float>(layer),
                                   0.05F + 0.1F * static_cast<float>(row)});
    }
    scene.total_particles = scene.particles.size();
    Simulation simulation(scene);
    const double height = mean(simulation.positions(), 1);
    for (int frame = 0; frame < 100; ++frame) simulation.advance(frame_seconds);
    expect_inside(simulation);
    EXPECT_NEAR(mean(simulation.positions(), 1), height, 0.15 * height);
}

TEST(AdaptiveLevels, KeepMassAndMergeOnlyWhatIsDeep) {
    constexpr float r = 0.05F;
    std::vector<float> positions;
    for (int z = 0; z < 20; ++z)
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 20; ++x)
                for (const int i : {x, y, z}) positions.push_back(r * (2.0F * static_cast<float>(i) + 1.0F));
    const Tank tank{{2.0F, 4.0F, 2.0F}};
    const LeveledParticles merged = merge_deep_particles(positions, r, tank);
    const auto coarse = static_cast<std::size_t>(std::count(merged.levels.begin(), merged.levels.end(), 1));
    const std::size_t fine = merged.levels.size() - coarse;
    EXPECT_EQ(fine + 8 * coarse, positions.size() / 3);
    EXPECT_EQ(coarse, 8U * 8U * 8U);  // all cells but those at the surface and the walls
    const float surface = 40.0F * r;
    double momentum = 0.0;
    for (std::size_t i = 0; i < merged.levels.size(); ++i) {
        if (merged.levels[i] == 1) {
            EXPECT_LT(merged.positions[3 * i + 1], surface - 4.0F * r);
        }
        momentum += static_cast<double>(merged.positions[3 * i + 1]) * (merged.levels[i] == 1 ? 8.0 : 1.0);
    }
    EXPECT_NEAR(momentum, mean(positions, 1) * static_cast<double>(positions.size()) / 3.0, 1e-2);
}

}  // namespace
}  // namespace meniscus::simulator
