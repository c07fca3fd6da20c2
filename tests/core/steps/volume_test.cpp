// The volume in the statistics is that of the mesh, exact until it is rounded to a double.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "meniscus/meniscus.hpp"
#include "steps/fill_cracks/volume.hpp"
#include "support/mesh_check.hpp"
#include "support/noise.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

__extension__ using Int128 = __int128;

/// Six times the volume, u^3, as the sum of the tetrahedra between the triangles and an apex.
Int128 sixfold_by_tetrahedra(const Mesh& mesh, const std::array<std::int64_t, 3>& apex) {
    Int128 sum = 0;
    for (const Triangle& triangle : mesh.triangles) {
        std::array<std::array<Int128, 3>, 3> p;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) p[i][k] = Int128{mesh.vertices[triangle[i]][k]} - apex[k];
        sum += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) + p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
               p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return sum;
}

std::uint64_t sixfold(const Mesh& mesh) {
    std::uint64_t sum = 0;
    for (const Triangle& triangle : mesh.triangles)
        sum += static_cast<std::uint64_t>(sixfold_volume(mesh.vertices.data(), triangle));
    return sum;
}

void expect_exact(const Mesh& mesh) {
    for (const std::array<std::int64_t, 3>& apex :
         {std::array<std::int64_t, 3>{0, 0, 0}, {123'456, -7, 99}, {-2'000'000'000, 1'999'999'999, 1'000'000'007}})
        EXPECT_TRUE(sixfold_by_tetrahedra(mesh, apex) == Int128{static_cast<std::int64_t>(sixfold(mesh))});
}

/// The statistics of a frame, whose mesh a reconstructor of its own makes.
Statistics statistics_of(const Settings& settings, const ParticleFrame& frame, Mesh& mesh, unsigned threads = 1) {
    Reconstructor reconstructor(settings, {Backend::cpu, threads, 0});
    reconstructor.reconstruct(frame, mesh);
    return reconstructor.statistics();
}

/// Water on a grid of spacing 2 r, within a distance of its middle.
test::Particles ball(float radius, float r) {
    test::Particles particles;
    const int reach = static_cast<int>(radius / (2 * r));
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) {
                const auto at = [r](int i) { return 2 * r * static_cast<float>(i); };
                if (at(x) * at(x) + at(y) * at(y) + at(z) * at(z) <= radius * radius)
                    particles.add(at(x), at(y), at(z));
            }
    return particles;
}

/// A cube of this edge, in u, from a corner on; outward.
Mesh cube(std::int32_t edge, const LatticePosition& from) {
    Mesh mesh;
    mesh.cell_size = 0.5;
    mesh.offset_bits = 6;
    for (std::int32_t i = 0; i < 8; ++i)
        mesh.vertices.push_back(
            {from[0] + edge * (i & 1), from[1] + edge * (i >> 1 & 1), from[2] + edge * (i >> 2 & 1)});
    for (const std::array<std::uint32_t, 4>& face : {std::array<std::uint32_t, 4>{0, 2, 3, 1},
                                                     {4, 5, 7, 6},
                                                     {0, 1, 5, 4},
                                                     {2, 6, 7, 3},
                                                     {0, 4, 6, 2},
                                                     {1, 3, 7, 5}}) {
        mesh.triangles.push_back({face[0], face[1], face[2]});
        mesh.triangles.push_back({face[0], face[2], face[3]});
    }
    return mesh;
}

TEST(Volume, OfACubeIsItsEdgeCubed) {
    const Mesh mesh = cube(256, {-64, 4096, 77});
    ASSERT_TRUE(test::check(mesh).closed_manifold());
    EXPECT_EQ(sixfold(mesh), 6U * 256 * 256 * 256);
    EXPECT_EQ(world_volume(sixfold(mesh), mesh.cell_size, mesh.offset_bits), 8.0);
}

TEST(Volume, OfACubeIsTheSameAtTheEdgesOfTheLattice) {
    const std::int32_t last = base_cell_size * 64 * max_base_cell;
    for (const std::int32_t x : {-last, last})
        for (const std::int32_t z : {-last, last}) EXPECT_EQ(sixfold(cube(256, {x, -last, z})), 6U * 256 * 256 * 256);
}

TEST(Volume, OfAMeshTurnedInsideOutIsNegative) {
    Mesh mesh = cube(256, {});
    for (Triangle& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
    EXPECT_EQ(world_volume(sixfold(mesh), mesh.cell_size, mesh.offset_bits), -8.0);
}

TEST(Volume, IsTheSumOfTetrahedraInAnyFrameOfReference) {
    const test::Particles particles = test::splash(41, 8);
    for (const Field field : choices<Field>)
        for (const Mode mode : {Mode::adaptive, Mode::uniform})
            for (const EdgePoints& edge_points : {EdgePoints{Interpolation{}}, EdgePoints{Bisection{7}}})
                for (const bool cropped : {false, true}) {
                    Settings settings = test::default_settings();
                    settings.field = field;
                    settings.mode = mode;
                    settings.edge_points = edge_points;
                    if (cropped) settings.domain = Box{{0.05, 0.02, 0.03}, {0.31, 0.17, 0.33}};
                    Mesh mesh;
                    const Statistics statistics = statistics_of(settings, particles.frame(), mesh);
                    expect_exact(mesh);
                    EXPECT_EQ(statistics.volume, world_volume(sixfold(mesh), mesh.cell_size, mesh.offset_bits));
                    EXPECT_GT(statistics.volume, 0.0);
                    EXPECT_NEAR(statistics.volume, test::check(mesh).volume, 1e-10 * statistics.volume);
                }
}

TEST(Volume, IsExactForWhiteNoise) {
    for (const bool uniform : {false, true})
        test::for_each_seed({.side = 4, .uniform = uniform}, 9001, 25,
                            [](const test::NoiseWorld& world) { expect_exact(test::mesh_of_noise_on_cpu(world)); });
}

TEST(Volume, OfABallIsNearThatOfItsParticles) {
    const Settings settings = test::default_settings();
    const auto r = static_cast<float>(settings.particle_radius);
    const test::Particles particles = ball(16.0F * r, r);
    Mesh mesh;
    const Statistics statistics = statistics_of(settings, particles.frame(), mesh);
    EXPECT_NEAR(statistics.particle_volume, static_cast<double>(particles.count()) * std::pow(0.05, 3),
                1e-12 * statistics.particle_volume);
    EXPECT_NEAR(statistics.volume, statistics.particle_volume, 0.1 * statistics.particle_volume);
}

TEST(Volume, OfFullWaterWithinADomainIsTheDomains) {
    test::Particles particles;
    constexpr int edge = 14;
    const auto at = [](int i) { return 0.05F * static_cast<float>(i); };
    for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x) particles.add(at(x), at(y), at(z));
    Settings settings = test::default_settings();
    settings.domain = Box{{0.25, 0.25, 0.25}, {0.4, 0.4, 0.4}};
    settings.mode = Mode::uniform;
    Mesh mesh;
    // 12 cells a side, of which the twelve edges lose half a cell's section each.
    EXPECT_NEAR(statistics_of(settings, particles.frame(), mesh).volume, (1 - 1.0 / 24) * 0.15 * 0.15 * 0.15,
                0.01 * 0.15 * 0.15 * 0.15);
}

TEST(Volume, HasTheSameBitsForAnyNumberOfThreadsAndAfterAMoveByWholeBricks) {
    // Exact in float32, and by bricks of support cells, too: those are 16 * 12 cells, 3 world units, a side.
    Settings settings;
    settings.particle_radius = 1.0 / 32;
    test::Particles here = ball(10.0F / 32, 1.0F / 32), there;
    for (std::size_t i = 0; i < here.count(); ++i)
        there.add(here.positions[3 * i] + 3072.0F, here.positions[3 * i + 1] - 6144.0F,
                  here.positions[3 * i + 2] - 48.0F);
    Mesh mesh;
    const double volume = statistics_of(settings, here.frame(), mesh).volume;
    ASSERT_GT(volume, 0.0);
    for (const unsigned threads : {2U, 3U, 8U})
        EXPECT_EQ(statistics_of(settings, here.frame(), mesh, threads).volume, volume) << threads;
    EXPECT_EQ(statistics_of(settings, there.frame(), mesh).volume, volume);
}

TEST(Volume, IsThatOfTheWholeMeshWhereItsLevelsAreCappedLater) {
    const test::Particles particles = test::splash(42, 8);
    Reconstructor reconstructor(test::default_settings(), {Backend::cpu, 1, 0});
    Mesh mesh, capped;
    const MeshDownload download = reconstructor.reconstruct_for_download(particles.frame(), mesh);
    download.finish();
    const double volume = reconstructor.statistics().volume;
    EXPECT_EQ(volume, world_volume(sixfold(mesh), mesh.cell_size, mesh.offset_bits));
    reconstructor.emit_capped(1, capped);
    EXPECT_NE(sixfold(capped), sixfold(mesh));
    EXPECT_EQ(reconstructor.statistics().volume, volume);
}

TEST(Volume, OfNoParticlesIsZero) {
    Mesh mesh;
    const Statistics statistics = statistics_of(test::default_settings(), ParticleFrame{}, mesh);
    EXPECT_EQ(statistics.volume, 0.0);
    EXPECT_EQ(statistics.particle_volume, 0.0);
}

TEST(ParticleVolume, GrowsWithTheCubeOfTheRadiusOfEachLevel) {
    test::Particles particles;
    for (int i = 0; i < 7; ++i) particles.add(static_cast<float>(i), 0.0F, 0.0F);
    particles.levels = {0, 0, 1, 2, 3, 3, 0};
    Settings settings;
    settings.particle_radius = 0.5;
    Mesh mesh;
    EXPECT_EQ(statistics_of(settings, particles.frame(), mesh).particle_volume, 3.0 + 8.0 + 64.0 + 2 * 512.0);
    particles.levels.clear();
    EXPECT_EQ(statistics_of(settings, particles.frame(), mesh).particle_volume, 7.0);
}

}  // namespace
}  // namespace meniscus
