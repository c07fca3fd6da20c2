// Frames in parts, put together again.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "meniscus/meniscus.hpp"
#include "meniscus/parts.hpp"
#include "support/attributes.hpp"
#include "support/particles.hpp"
#include "support/same_bytes.hpp"

namespace meniscus::test {

struct FrameOfParts {
    std::map<std::size_t, Mesh> meshes;
    std::map<std::size_t, std::uint32_t> overlaps;
    PartsReport report;

    Mesh whole() const {
        std::vector<Mesh> parts;
        for (const auto& [number, mesh] : meshes) parts.push_back(mesh);
        return put_together(parts);
    }
    PartSink sink() {
        return [this](const FinishedPart& part) {
            meshes[part.number] = part.mesh;
            overlaps[part.number] = part.part.overlap;
        };
    }
};

/// In one process, on the CPU.
inline FrameOfParts in_parts(const Settings& settings, const ParticleFrame& frame, const PartsOptions& options) {
    AloneExchange alone;
    PartsReconstructor reconstructor(settings, {Backend::cpu, 1, 0}, options, alone);
    FrameOfParts result;
    result.report = reconstructor.reconstruct(frame, result.sink());
    return result;
}

inline std::vector<Point> sorted_spray(const Mesh& mesh) {
    std::vector<Point> spray(mesh.spray.begin(), mesh.spray.end());
    std::sort(spray.begin(), spray.end());
    return spray;
}

/// Expects the same mesh, to the bit and in the same order; of spray, the same places.
inline void expect_same_mesh(const Mesh& mesh, const Mesh& whole) {
    EXPECT_EQ(mesh_sha256(mesh), mesh_sha256(whole));
    EXPECT_EQ(bricks_sha256(mesh), bricks_sha256(whole));
    EXPECT_TRUE(same_bytes(mesh.vertices, whole.vertices));
    EXPECT_TRUE(same_bytes(mesh.normals, whole.normals));
    EXPECT_TRUE(same_bytes(mesh.triangles, whole.triangles));
    EXPECT_TRUE(same_bytes(mesh.bricks, whole.bricks));
    EXPECT_TRUE(same_attributes(mesh, whole));
    EXPECT_EQ(sorted_spray(mesh), sorted_spray(whole));
}

/// Expects of a frame's parts all that its whole gives.
inline void expect_the_whole(const Settings& settings, const ParticleFrame& frame, const PartsOptions& options) {
    Reconstructor reconstructor(settings, {Backend::cpu, 1, 0});
    Mesh whole;
    reconstructor.reconstruct(frame, whole);
    const FrameOfParts parts = in_parts(settings, frame, options);
    expect_same_mesh(parts.whole(), whole);
    const Statistics& statistics = reconstructor.statistics();
    const Statistics& of_parts = parts.report.whole;
    EXPECT_EQ(of_parts.particles, statistics.particles);
    EXPECT_EQ(of_parts.vertices, statistics.vertices);
    EXPECT_EQ(of_parts.triangles, statistics.triangles);
    EXPECT_EQ(of_parts.triangles_by_level, statistics.triangles_by_level);
    EXPECT_EQ(of_parts.base_cells_by_level, statistics.base_cells_by_level);
    EXPECT_EQ(of_parts.volume, statistics.volume);
    EXPECT_EQ(of_parts.particle_volume, statistics.particle_volume);
    EXPECT_EQ(of_parts.spray_particles, statistics.spray_particles);
    EXPECT_EQ(of_parts.warnings, statistics.warnings);
    EXPECT_GE(of_parts.field_evaluations, statistics.field_evaluations);
}

/// White noise that fills a cube: `filling` times as many particles as at rest.
inline Particles noise_cube(unsigned seed, int count, double filling, double radius) {
    std::mt19937 random(seed);
    const double edge = 2.0 * radius * std::cbrt(count / filling);
    std::uniform_real_distribution<float> place(0.0F, static_cast<float>(edge));
    Particles particles;
    for (int i = 0; i < count; ++i) {
        const float x = place(random), y = place(random), z = place(random);
        particles.add(x, y, z);
    }
    return particles;
}

}  // namespace meniscus::test
