// A domain crops the surface and closes it at the border.
#include <gtest/gtest.h>

#include "meniscus/meniscus.hpp"
#include "support/mesh_check.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

TEST(Domain, CropsTheSurfaceClosedAtItsBorder) {
    const test::Particles particles = test::splash(31);
    const std::vector<Box> boxes{{{0.11, -0.02, 0.13}, {0.42, 0.2, 0.37}},
                                 {{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}},
                                 {{-9, 0.07, -9}, {9, 0.08, 9}},
                                 {{0.2, -1, 0.2}, {0.2001, 1, 0.2001}}};
    for (const Box& box : boxes)
        for (const Mode mode : {Mode::adaptive, Mode::uniform})
            for (const EdgePoints& edge_points : choices<EdgePoints>)
                for (const double cell_size : {0.5, 1.0}) {
                    Settings settings = test::default_settings();
                    settings.domain = box;
                    settings.mode = mode;
                    settings.edge_points = edge_points;
                    settings.cell_size = cell_size;
                    const Mesh mesh = test::reconstruct(settings, particles.frame());
                    const test::MeshReport report = test::check(mesh);
                    EXPECT_TRUE(report.closed_manifold()) << report.text();
                    const double c = world_cell_size(settings);
                    for (const LatticePosition& v : mesh.vertices) {
                        const auto p = mesh.world(v);
                        for (std::size_t axis = 0; axis < 3; ++axis) {
                            ASSERT_GT(p[axis], box.min[axis] - c);
                            ASSERT_LT(p[axis], box.max[axis] + c);
                        }
                    }
                }
}

// The margin that the documents give for a part of a frame.
TEST(Domain, DependsOnNoParticleBeyondTheMargin) {
    const test::Particles all = test::splash(33, 24);
    for (const Field field : choices<Field>)
        for (const std::uint32_t smoothness : {5U, 6U, 7U}) {
            if (field != Field::smooth && smoothness != 6) continue;
            Settings settings = test::default_settings();
            settings.field = field;
            if (field == Field::smooth) settings.smoothness = smoothness;
            settings.iso = field == Field::density ? 0.2 : 0.6;
            settings.domain = Box{{-1.0, -1.0, -1.0}, {0.21, 9.0, 9.0}};
            const double reach = margin(settings) * settings.particle_radius;
            test::Particles part;
            for (std::size_t i = 0; i < all.count(); ++i)
                if (static_cast<double>(all.positions[3 * i]) <= settings.domain->max[0] + reach)
                    part.add(all.positions[3 * i], all.positions[3 * i + 1], all.positions[3 * i + 2]);
            ASSERT_LT(part.count(), all.count() - 100);
            const Mesh mesh = test::reconstruct(settings, part.frame());
            ASSERT_FALSE(mesh.triangles.empty());
            EXPECT_EQ(mesh_sha256(mesh), mesh_sha256(test::reconstruct(settings, all.frame())))
                << name_of(field) << " " << smoothness;
        }
}

TEST(Domain, CutsFullWaterFlatNextToTheBorder) {
    test::Particles particles;
    for (int z = 0; z < 12; ++z)
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 12; ++x)
                particles.add(static_cast<float>(x) * 0.05F, static_cast<float>(y) * 0.05F,
                              static_cast<float>(z) * 0.05F);
    Settings settings = test::default_settings();
    settings.domain = Box{{0.2, 0.2, 0.2}, {0.35, 0.35, 0.35}};
    settings.mode = Mode::uniform;
    const Mesh mesh = test::reconstruct(settings, particles.frame());
    const double c = world_cell_size(settings);
    const test::MeshReport report = test::check(mesh);
    ASSERT_TRUE(report.closed_manifold()) << report.text();
    // 12 cells a side, of which the twelve edges lose half a cell's section each: 12 x 12 / 2 of 12^3 cells.
    EXPECT_NEAR(report.volume, (1 - 1.0 / 24) * 0.15 * 0.15 * 0.15, 0.01 * 0.15 * 0.15 * 0.15);
    std::size_t flat = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const auto p = mesh.world(mesh.vertices[v]);
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (p[axis] > 0.35 - c / 32) {
                ++flat;
                EXPECT_FLOAT_EQ(mesh.normals[v][axis], 1.0F);
            }
    }
    EXPECT_GT(flat, 200U);
}

TEST(Domain, ThatHoldsEverythingChangesNothing) {
    const test::Particles particles = test::splash(32, 8);
    Settings settings = test::default_settings();
    const Mesh free = test::reconstruct(settings, particles.frame());
    settings.domain = Box{{-50, -50, -50}, {50, 50, 50}};
    EXPECT_EQ(mesh_sha256(test::reconstruct(settings, particles.frame())), mesh_sha256(free));
    settings.domain = Box{{-1e300, -1e300, -1e300}, {1e300, 1e300, 1e300}};
    EXPECT_EQ(mesh_sha256(test::reconstruct(settings, particles.frame())), mesh_sha256(free));
}

TEST(Domain, FarFromTheFluidGivesAnEmptyMesh) {
    Settings settings = test::default_settings();
    settings.domain = Box{{50, 50, 50}, {51, 51, 51}};
    EXPECT_TRUE(test::reconstruct(settings, test::splash(33, 6).frame()).triangles.empty());
}

}  // namespace
}  // namespace meniscus
