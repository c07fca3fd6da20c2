// The same frame gives the same mesh, bit for bit, on any backend and at any place.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "meniscus/meniscus.hpp"
#include "support/particles.hpp"
#include "support/same_bytes.hpp"

namespace meniscus {
namespace {

bool same(const Mesh& a, const Mesh& b) {
    return test::same_bytes(a.vertices, b.vertices) && test::same_bytes(a.normals, b.normals) &&
           test::same_bytes(a.triangles, b.triangles);
}

TEST(Reproducibility, AnyNumberOfThreadsGivesTheSameBytes) {
    const test::Particles particles = test::splash(5);
    for (const Field field : {Field::color, Field::density, Field::smooth})
        for (const EdgePoints& edge_points : choices<EdgePoints>) {
            Settings settings = test::default_settings();
            settings.field = field;
            settings.edge_points = edge_points;
            const Mesh one = test::reconstruct(settings, particles.frame(), 1);
            ASSERT_FALSE(one.triangles.empty());
            for (const unsigned threads : {2U, 3U, 8U})
                EXPECT_TRUE(same(one, test::reconstruct(settings, particles.frame(), threads))) << threads;
        }
}

TEST(Reproducibility, TheOrderOfParticlesDoesNotMatter) {
    test::Particles particles = test::splash(6);
    for (std::size_t i = 0; i < particles.count(); ++i) particles.levels.push_back(i % 5 == 0 ? 1 : 0);
    std::vector<std::size_t> order(particles.count());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    test::Particles shuffled;
    for (const std::size_t i : order) {
        shuffled.add(particles.positions[3 * i], particles.positions[3 * i + 1], particles.positions[3 * i + 2]);
        shuffled.levels.push_back(particles.levels[i]);
    }
    const Settings settings = test::default_settings();
    EXPECT_TRUE(
        same(test::reconstruct(settings, particles.frame(), 1), test::reconstruct(settings, shuffled.frame(), 2)));
}

TEST(Reproducibility, AUsedReconstructorGivesTheSameBytesAsANewOne) {
    const Settings settings = test::default_settings();
    Reconstructor used(settings, {Backend::cpu, 2, 0});
    Mesh mesh;
    for (unsigned seed = 1; seed <= 4; ++seed) {
        const test::Particles particles = test::splash(seed, 6 + 2 * static_cast<int>(seed % 3));
        used.reconstruct(particles.frame(), mesh);
        EXPECT_TRUE(same(mesh, test::reconstruct(settings, particles.frame(), 1))) << seed;
    }
}

TEST(Reproducibility, AFluidMovedByWholeBricksKeepsItsShapeToTheBit) {
    // Radius, cell and positions are powers of two and small multiples of them, so that the move is exact in float32.
    Settings settings;
    settings.particle_radius = 1.0 / 32;
    settings.cell_size = 0.5;
    std::mt19937 random(3);
    std::uniform_int_distribution<int> place(0, 1023);
    test::Particles here, there;
    // 192 bricks of 64 cells of 1/64: whole bricks of support cells, too, whose edge is the support of 12 cells, so
    // that the order of sums stays.
    constexpr int bricks = 192;
    const float shift = static_cast<float>(bricks);
    for (int i = 0; i < 400; ++i) {
        const float p[3] = {static_cast<float>(place(random)) / 2048.0F, static_cast<float>(place(random)) / 2048.0F,
                            static_cast<float>(place(random)) / 2048.0F};
        here.add(p[0], p[1], p[2]);
        there.add(p[0] + shift, p[1] - shift, p[2] + 2 * shift);
    }
    const Mesh a = test::reconstruct(settings, here.frame(), 1);
    const Mesh b = test::reconstruct(settings, there.frame(), 1);
    ASSERT_FALSE(a.triangles.empty());
    ASSERT_TRUE(test::same_bytes(a.triangles, b.triangles));
    EXPECT_TRUE(test::same_bytes(a.normals, b.normals));
    const std::int32_t step = bricks * 64 * 64;
    for (std::size_t v = 0; v < a.vertices.size(); ++v)
        ASSERT_EQ(b.vertices[v],
                  (LatticePosition{a.vertices[v][0] + step, a.vertices[v][1] - step, a.vertices[v][2] + 2 * step}));
}

TEST(Reproducibility, TheHashDoesNotDependOnTheOrderOfTriangles) {
    const test::Particles particles = test::splash(7, 6);
    Mesh mesh = test::reconstruct(test::default_settings(), particles.frame(), 1);
    const std::string before = mesh_sha256(mesh);
    ASSERT_EQ(before.size(), 64U);
    const auto first = mesh.triangles.begin() + mesh.levels[2].first;
    std::reverse(first, first + mesh.levels[2].count);
    std::rotate(first->begin(), first->begin() + 1, first->end());
    EXPECT_EQ(mesh_sha256(mesh), before);
    std::swap((*first)[0], (*first)[1]);
    EXPECT_NE(mesh_sha256(mesh), before);
}

TEST(Reproducibility, TheHashOfAKnownMeshIsKnown) {
    // One triangle, computed independently: struct.pack('<dIQ', 0.5, 6, 1) + struct.pack('<B9i', 3, -1, 2, 3, 4, 5, 6,
    // 7, 8, -9).
    Mesh mesh;
    mesh.cell_size = 0.5;
    mesh.offset_bits = 6;
    mesh.vertices = {{4, 5, 6}, {7, 8, -9}, {-1, 2, 3}};
    mesh.triangles = {{0, 1, 2}};
    mesh.levels[2] = {0, 1};
    mesh.levels[3] = {1, 0};
    EXPECT_EQ(mesh_sha256(mesh), "f01e512fe588cc7fb5f65d97528656a5a5189e4a1c8c2f815c2f750cadeb4b0a");
}

}  // namespace
}  // namespace meniscus
