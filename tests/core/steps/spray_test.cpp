// Particles without company: kept as drops, left out, or listed.
#include <gtest/gtest.h>

#include <algorithm>

#include "meniscus/meniscus.hpp"
#include "support/mesh_check.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

/// A splash, and particles far from it and from each other.
test::Particles splash_with_spray(int spray) {
    test::Particles particles = test::splash(11, 6);
    for (int i = 0; i < spray; ++i) particles.add(1.0F + 0.25F * static_cast<float>(i), 0.5F, -0.75F);
    return particles;
}

struct Result {
    Mesh mesh;
    Statistics statistics;
    std::size_t components;
};

Result reconstruct(const test::Particles& particles, Spray spray) {
    Settings settings = test::default_settings();
    settings.spray = spray;
    Reconstructor reconstructor(settings, {Backend::cpu, 1});
    Result result;
    reconstructor.reconstruct(particles.frame(), result.mesh);
    result.statistics = reconstructor.statistics();
    const test::MeshReport report = test::check(result.mesh);
    EXPECT_TRUE(report.closed_manifold()) << report.text();
    result.components = report.components;
    return result;
}

TEST(Spray, IsCountedWhateverBecomesOfIt) {
    const std::uint64_t of_the_splash = reconstruct(splash_with_spray(0), Spray::keep).statistics.spray_particles;
    for (const Spray spray : choices<Spray>)
        EXPECT_EQ(reconstruct(splash_with_spray(7), spray).statistics.spray_particles, of_the_splash + 7)
            << name_of(spray);
}

TEST(Spray, IsADropEachWhereItIsKept) {
    EXPECT_EQ(reconstruct(splash_with_spray(7), Spray::keep).components,
              reconstruct(splash_with_spray(0), Spray::keep).components + 7);
}

TEST(Spray, LeavesTheSurfaceOfTheRestToTheBit) {
    const Result without = reconstruct(splash_with_spray(0), Spray::discard);
    for (const Spray spray : {Spray::discard, Spray::points})
        EXPECT_EQ(mesh_sha256(reconstruct(splash_with_spray(7), spray).mesh), mesh_sha256(without.mesh))
            << name_of(spray);
}

TEST(Spray, IsListedAtItsPlacesWhereItIsToBePoints) {
    const Result result = reconstruct(splash_with_spray(7), Spray::points);
    ASSERT_EQ(result.mesh.spray.size(), result.statistics.spray_particles);
    for (int i = 0; i < 7; ++i)
        EXPECT_TRUE(std::any_of(result.mesh.spray.begin(), result.mesh.spray.end(), [&](const Point& p) {
            return std::abs(p[0] - (1.0F + 0.25F * static_cast<float>(i))) < 1e-5F && std::abs(p[1] - 0.5F) < 1e-5F &&
                   std::abs(p[2] + 0.75F) < 1e-5F;
        })) << i;
    for (const Spray spray : {Spray::keep, Spray::discard})
        EXPECT_TRUE(reconstruct(splash_with_spray(7), spray).mesh.spray.empty()) << name_of(spray);
}

TEST(Spray, IsListedInOneOrderWhateverThatOfTheFrame) {
    const test::Particles particles = splash_with_spray(7);
    test::Particles reversed;
    for (std::size_t i = particles.count(); i-- > 0;)
        reversed.add(particles.positions[3 * i], particles.positions[3 * i + 1], particles.positions[3 * i + 2]);
    const Result a = reconstruct(particles, Spray::points), b = reconstruct(reversed, Spray::points);
    ASSERT_FALSE(a.mesh.spray.empty());
    EXPECT_TRUE(std::equal(a.mesh.spray.begin(), a.mesh.spray.end(), b.mesh.spray.begin(), b.mesh.spray.end()));
}

TEST(Spray, IsPartOfAMeshOfCappedLevelsAndOfTheMemoryThatIsCounted) {
    const test::Particles particles = splash_with_spray(7);
    Settings settings = test::default_settings();
    settings.spray = Spray::points;
    Reconstructor reconstructor(settings, {Backend::cpu, 1});
    Mesh mesh, capped;
    reconstructor.reconstruct(particles.frame(), mesh);
    reconstructor.emit_capped(1, capped);
    ASSERT_FALSE(mesh.spray.empty());
    EXPECT_TRUE(std::equal(mesh.spray.begin(), mesh.spray.end(), capped.spray.begin(), capped.spray.end()));
    EXPECT_EQ(mesh.spray.get_allocator().account(), mesh.vertices.get_allocator().account());
}

TEST(Spray, AloneLeavesNothing) {
    test::Particles one;
    one.add(0.25F, 0.5F, -1.0F);
    EXPECT_TRUE(reconstruct(one, Spray::discard).mesh.triangles.empty());
    const Result listed = reconstruct(one, Spray::points);
    EXPECT_TRUE(listed.mesh.triangles.empty());
    ASSERT_EQ(listed.mesh.spray.size(), 1U);
    EXPECT_EQ(listed.mesh.spray[0], (Point{0.25F, 0.5F, -1.0F}));
    EXPECT_FALSE(reconstruct(one, Spray::keep).mesh.triangles.empty());
}

}  // namespace
}  // namespace meniscus
