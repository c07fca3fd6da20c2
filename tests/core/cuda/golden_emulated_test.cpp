// Meshes keep every bit from commit to commit: on the software device, for generated scenes and for real frames.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "formats/particles/particle_file.hpp"
#include "meniscus/meniscus.hpp"
#include "pipeline/backend.hpp"
#include "support/golden_rows.hpp"

namespace meniscus {
namespace {

/// Reconstructs on the software device, which the Reconstructor does not offer as a backend.
Mesh reconstruct(const Settings& settings, const ParticleFrame& frame, int max_level) {
    const auto backend = cuda::make_reconstruction(settings, BackendOptions{}, std::make_shared<MemoryAccount>(),
                                                   std::make_shared<MemoryAccount>(0, "on the GPU"));
    Mesh mesh;
    mesh.cell_size = world_cell_size(settings);
    mesh.offset_bits = offset_bits(settings);
    Statistics statistics;
    backend->reconstruct(frame, mesh, statistics).finish();
    if (max_level < 3) backend->emit_capped(max_level, mesh);
    return mesh;
}

TEST(GoldenEmulated, MeshesKeepTheirBits) {
    test::expect_golden_meshes([](const test::GoldenRow& row, const ParticleFrame& frame) {
        return reconstruct(row.settings(), frame, row.max_level);
    });
}

// Run by tests/acceptance/golden-frames, which compares the line of each mesh with its table: too long for the suite.
TEST(GoldenEmulated, DISABLED_RealFramesGiveTheCpusBits) {
    const char* data = std::getenv("MENISCUS_DATA");
    if (!data) GTEST_SKIP() << "MENISCUS_DATA is not set";
    for (const char* frame : {"frame_040.vtk", "frame_258.vtk"})
        for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
            const char* const mode_name = mode == Mode::adaptive ? "adaptive" : "uniform";
            SCOPED_TRACE(testing::Message() << frame << " " << mode_name);
            const formats::Particles particles =
                formats::read_particles(std::filesystem::path(data) / "double_dam_break_with_sphere" / frame);
            test::GoldenRow row{};
            row.field = Field::color;
            row.mode = mode;
            row.smoothing = 2.0;
            row.cell_size = 1.0;
            row.iso = 0.6;
            row.tolerance = 0.15;
            row.normals = true;
            const Mesh mesh = reconstruct(row.settings(), particles.frame(), 3);
            Mesh expected;
            Reconstructor(row.settings(), {Backend::cpu, 1}).reconstruct(particles.frame(), expected);
            EXPECT_EQ(test::golden_bytes(mesh), test::golden_bytes(expected));
            std::cout << "golden: " << frame << " " << mode_name << " 1.0 " << mesh_sha256(mesh) << "\n";
        }
}

}  // namespace
}  // namespace meniscus
