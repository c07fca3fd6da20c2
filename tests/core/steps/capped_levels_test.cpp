// The last frame's surface, emitted again with its levels capped.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "meniscus/meniscus.hpp"
#include "support/mesh_check.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

std::vector<Settings> all_settings() {
    std::vector<Settings> all;
    for (const Mode mode : {Mode::adaptive, Mode::uniform})
        for (const Field field : {Field::color, Field::density, Field::smooth})
            for (const EdgePoints& edge_points : choices<EdgePoints>) {
                Settings settings = test::default_settings();
                settings.mode = mode;
                settings.field = field;
                settings.edge_points = edge_points;
                settings.iso = field == Field::density ? 0.2 : 0.6;
                all.push_back(settings);
            }
    return all;
}

TEST(CappedLevels, GiveClosedManifoldsWithoutFinerTriangles) {
    std::vector<test::NamedParticles> inputs = test::adversarial(0.025F);
    inputs.push_back({"splash", test::splash(1)});
    for (const Settings& settings : all_settings()) {
        Reconstructor reconstructor(settings, {Backend::cpu, 1});
        Mesh mesh;
        for (const auto& [name, particles] : inputs) {
            reconstructor.reconstruct(particles.frame(), mesh);
            const std::size_t full = mesh.triangles.size();
            for (const int max_level : {1, 2}) {
                reconstructor.emit_capped(max_level, mesh);
                const test::MeshReport report = test::check(mesh);
                EXPECT_TRUE(report.closed_manifold())
                    << name << ", levels up to " << max_level << ": " << report.text();
                for (std::size_t level = static_cast<std::size_t>(max_level); level < 3; ++level)
                    EXPECT_EQ(mesh.levels[level].count, 0U) << name;
                EXPECT_LE(mesh.triangles.size(), full) << name;
            }
        }
    }
}

TEST(CappedLevels, GiveTheFullMeshWhereTheCapIsTheFinestLevelWhateverWasEmittedBefore) {
    const test::Particles particles = test::splash(2);
    for (const Settings& settings : all_settings()) {
        Reconstructor reconstructor(settings, {Backend::cpu, 1});
        Mesh mesh;
        reconstructor.reconstruct(particles.frame(), mesh);
        const std::string full = mesh_sha256(mesh);
        reconstructor.emit_capped(2, mesh);
        const std::string at_most_2 = mesh_sha256(mesh);
        reconstructor.emit_capped(1, mesh);
        EXPECT_NE(mesh_sha256(mesh), full);
        reconstructor.emit_capped(3, mesh);
        EXPECT_EQ(mesh_sha256(mesh), full);
        reconstructor.emit_capped(2, mesh);
        EXPECT_EQ(mesh_sha256(mesh), at_most_2);
        reconstructor.reconstruct(particles.frame(), mesh);
        EXPECT_EQ(mesh_sha256(mesh), full);
    }
}

TEST(CappedLevels, KeepTheVolumeOfTheFluid) {
    Reconstructor reconstructor(test::default_settings(), {Backend::cpu, 1});
    Mesh mesh;
    reconstructor.reconstruct(test::splash(4, 16).frame(), mesh);
    const double full = test::check(mesh).volume;
    for (const int max_level : {2, 1}) {
        reconstructor.emit_capped(max_level, mesh);
        EXPECT_NEAR(test::check(mesh).volume, full, (max_level == 2 ? 0.03 : 0.1) * full) << max_level;
    }
}

TEST(CappedLevels, AreTheSameOnAnyNumberOfThreads) {
    const test::Particles particles = test::splash(5);
    Mesh one, three;
    Reconstructor on_one(test::default_settings(), {Backend::cpu, 1}),
        on_three(test::default_settings(), {Backend::cpu, 3});
    on_one.reconstruct(particles.frame(), one);
    on_three.reconstruct(particles.frame(), three);
    for (const int max_level : {1, 2}) {
        on_one.emit_capped(max_level, one);
        on_three.emit_capped(max_level, three);
        EXPECT_EQ(mesh_sha256(one), mesh_sha256(three));
    }
}

TEST(CappedLevels, NeedASurfaceAndALevel) {
    Reconstructor reconstructor(test::default_settings(), {Backend::cpu, 1});
    Mesh mesh;
    EXPECT_THROW(reconstructor.emit_capped(2, mesh), InvalidInput);
    reconstructor.reconstruct(test::splash(1, 4).frame(), mesh);
    for (const int max_level : {-1, 0, 4}) EXPECT_THROW(reconstructor.emit_capped(max_level, mesh), InvalidInput);
    EXPECT_NO_THROW(reconstructor.emit_capped(2, mesh));
    test::Particles bad = test::splash(1, 4);
    bad.positions[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(reconstructor.reconstruct(bad.frame(), mesh), InvalidInput);
    EXPECT_NO_THROW(reconstructor.emit_capped(2, mesh)) << "the surface before a frame that is refused";
}

}  // namespace
}  // namespace meniscus
