// Closed, oriented 2-manifolds for every input, in every combination of settings.
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "field/smooth_field.hpp"
#include "meniscus/meniscus.hpp"
#include "support/mesh_check.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

void expect_closed_in_all_settings(const std::string& name, const test::Particles& particles,
                                   std::initializer_list<double> cell_sizes) {
    for (const double cell_size : cell_sizes)
        for (const Mode mode : {Mode::adaptive, Mode::uniform})
            for (const Field field : {Field::color, Field::density, Field::smooth})
                for (const EdgePoints& edge_points : choices<EdgePoints>) {
                    Settings settings = test::default_settings();
                    settings.cell_size = cell_size;
                    settings.mode = mode;
                    settings.field = field;
                    settings.edge_points = edge_points;
                    // One particle alone has a density of 0.32 at its place: low enough an iso-value shows it in both
                    // fields.
                    settings.iso = field == Field::density ? 0.2 : 0.6;
                    const Mesh mesh = test::reconstruct(settings, particles.frame());
                    const test::MeshReport report = test::check(mesh);
                    SCOPED_TRACE(testing::Message() << name << ", cell size " << cell_size << ", " << name_of(mode)
                                                    << ", " << name_of(field) << ", " << name_of(edge_points));
                    EXPECT_TRUE(report.closed_manifold()) << report.text();
                    // The paper's criterion takes crowded cells for calm water, so that a lone crowded drop may be
                    // lost.
                    if (mode == Mode::uniform) {
                        EXPECT_GT(report.volume, 0.0);
                    }
                }
}

TEST(Manifold, HoldsForASplash) {
    expect_closed_in_all_settings("splash", test::splash(1), {0.5, 1.0});
}

TEST(Manifold, HoldsForAdversarialParticles) {
    for (const auto& [name, particles] : test::adversarial(0.025F))
        expect_closed_in_all_settings(name, particles, {0.5, 1.0});
}

TEST(Manifold, HoldsForCellsLargerThanTheSupport) {
    expect_closed_in_all_settings("coarse", test::splash(2, 8), {2.5, 4.5});
}

TEST(Manifold, HoldsForManyRandomClouds) {
    std::size_t triangles = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> place(-0.25F, 0.25F);
        test::Particles particles;
        for (int i = 0; i < 250; ++i) particles.add(place(random), place(random), place(random));
        Settings settings = test::default_settings();
        settings.cell_size = 0.4 + 0.02 * seed;
        const Mesh mesh = test::reconstruct(settings, particles.frame());
        const test::MeshReport report = test::check(mesh);
        ASSERT_TRUE(report.closed_manifold()) << "seed " << seed << ": " << report.text();
        triangles += mesh.triangles.size();
    }
    EXPECT_GT(triangles, 60U * 1000U);
}

TEST(Manifold, HoldsForAdaptiveSph) {
    test::Particles particles = test::splash(3);
    for (std::size_t i = 0; i < particles.count(); ++i)
        particles.levels.push_back(static_cast<std::uint8_t>(i % 7 == 0 ? 2 : i % 3 == 0 ? 1 : 0));
    for (const double cell_size : {0.5, 1.0})
        for (const Criterion& criterion :
             {Criterion(CurvatureCriterion{}), Criterion(CountCriterion{1}), Criterion(CountCriterion{2})}) {
            Settings settings = test::default_settings();
            settings.cell_size = cell_size;
            settings.criterion = criterion;
            for (const Field field : choices<Field>) {
                settings.field = field;
                settings.iso = field == Field::density ? 0.2 : 0.6;
                const Mesh mesh = test::reconstruct(settings, particles.frame());
                const test::MeshReport report = test::check(mesh);
                EXPECT_TRUE(report.closed_manifold()) << name_of(field) << ": " << report.text();
                EXPECT_FALSE(mesh.triangles.empty());
                if (field == Field::color) {
                    EXPECT_GT(mesh.levels[2].count, 0U);
                }
            }
        }
}

TEST(Manifold, AnEmptyFrameGivesAnEmptyMesh) {
    const Mesh mesh = test::reconstruct(test::default_settings(), {});
    EXPECT_TRUE(mesh.vertices.empty());
    EXPECT_TRUE(mesh.triangles.empty());
    EXPECT_TRUE(mesh.bricks.empty());
}

TEST(Manifold, AFieldBelowTheIsoValueGivesAnEmptyMesh) {
    test::Particles particles;
    particles.add(0.0F, 0.0F, 0.0F);
    Settings settings = test::default_settings();
    settings.field = Field::density;  // at most 8 / (8 pi) = 0.32 for one particle
    EXPECT_TRUE(test::reconstruct(settings, particles.frame()).triangles.empty());
}

TEST(Manifold, ASingleParticleIsASphere) {
    test::Particles particles;
    particles.add(0.01F, -0.02F, 0.03F);
    // color of one particle: W(q) / W(0), which is 1 - 6 q^2 + 6 q^3 for q below one half; the surface is where it is
    // 0.6.
    double low = 0.0, high = 0.5;
    for (int i = 0; i < 60; ++i) {
        const double q = (low + high) / 2;
        (1 - 6 * q * q + 6 * q * q * q > 0.6 ? low : high) = q;
    }
    // smooth: (1 - q^2)^3, with the support of a particle alone.
    const double smooth_radius = double{SmoothField().lone_support} * std::sqrt(1 - std::cbrt(0.6));
    for (const auto& [field, radii] : {std::pair{Field::color, 4.0 * low}, std::pair{Field::smooth, smooth_radius}}) {
        SCOPED_TRACE(name_of(field));
        Settings settings = test::default_settings();
        settings.field = field;
        settings.cell_size = 0.1;
        settings.mode = Mode::uniform;
        const Mesh mesh = test::reconstruct(settings, particles.frame());
        const test::MeshReport report = test::check(mesh);
        const double radius = radii * settings.particle_radius;
        EXPECT_NEAR(report.volume, 4.0 / 3.0 * std::numbers::pi * radius * radius * radius, 0.01 * report.volume);
        EXPECT_EQ(report.components, 1U);
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
            const auto p = mesh.world(mesh.vertices[v]);
            const double d[3] = {p[0] - 0.01F, p[1] + 0.02F, p[2] - 0.03F};
            const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            const auto& n = mesh.normals[v];
            EXPECT_GT((d[0] * n[0] + d[1] * n[1] + d[2] * n[2]) / length, 0.999);
        }
    }
}

}  // namespace
}  // namespace meniscus
