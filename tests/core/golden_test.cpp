// Meshes keep every bit from commit to commit: on the CPU. (On the software device: golden_emulated_test.cpp.)
#include <gtest/gtest.h>

#include "meniscus/reconstructor.hpp"
#include "support/golden_rows.hpp"

namespace meniscus {
namespace {

/// Rows differ in their settings, so each has a reconstructor of its own.
Mesh reconstruct(const test::GoldenRow& row, const ParticleFrame& frame, unsigned threads) {
    Reconstructor reconstructor(row.settings(), {Backend::cpu, threads});
    Mesh mesh;
    reconstructor.reconstruct(frame, mesh);
    if (row.max_level < 3) reconstructor.emit_capped(row.max_level, mesh);
    return mesh;
}

TEST(Golden, MeshesKeepTheirBits) {
    test::expect_golden_meshes(
        [](const test::GoldenRow& row, const ParticleFrame& frame) { return reconstruct(row, frame, 1); });
}

TEST(Golden, MeshesKeepTheirBitsOnThreeThreads) {
    test::expect_golden_meshes(
        [](const test::GoldenRow& row, const ParticleFrame& frame) { return reconstruct(row, frame, 3); });
}

}  // namespace
}  // namespace meniscus
