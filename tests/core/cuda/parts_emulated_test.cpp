// Parts of a frame on a device in software: the CPU's meshes and seams, to the bit.
#include <gtest/gtest.h>

#include "meniscus/meniscus.hpp"
#include "particles/seams.hpp"
#include "parts/brick_deal.hpp"
#include "pipeline/backend.hpp"
#include "support/parts.hpp"
#include "support/same_bytes.hpp"

namespace meniscus {
namespace {

class EmulatedParts {
public:
    explicit EmulatedParts(const Settings& settings)
        : settings_(settings),
          backend_(cuda::make_reconstruction(settings, BackendOptions{}, std::make_shared<MemoryAccount>(),
                                             std::make_shared<MemoryAccount>(0, "on the GPU"))) {}

    void expect_the_cpus_parts(const ParticleFrame& frame, std::size_t parts, std::uint32_t overlap) {
        for (const BrickBox& own : deal_bricks(brick_loads(frame, settings_), parts).boxes) {
            FramePart part;
            part.own = own;
            part.overlap = overlap;
            Reconstructor cpu(settings_, {Backend::cpu, 1, 0});
            Mesh expected;
            const PartOutcome outcome = cpu.reconstruct_part(frame, part, expected);
            PlacedFrame placed(frame);
            placed.part = lattice_part(part);
            run(placed, expected);
            expect_equal(expected);
            const PartOutcome on_device = backend_->part_outcome();
            EXPECT_EQ(on_device.seams, outcome.seams);
            EXPECT_EQ(on_device.sixfold_volume, outcome.sixfold_volume);
            EXPECT_TRUE(test::same_bytes(mesh_.spray, expected.spray));
            EXPECT_EQ(statistics_.field_evaluations, cpu.statistics().field_evaluations);
            EXPECT_EQ(statistics_.base_cells_by_level, cpu.statistics().base_cells_by_level);
            EXPECT_EQ(statistics_.spray_particles, cpu.statistics().spray_particles);
            for (const int max_level : {2, 1}) {
                cpu.emit_capped(max_level, expected);
                backend_->emit_capped(max_level, mesh_);
                expect_equal(expected);
            }
        }
    }
    void expect_the_whole(const ParticleFrame& frame) {
        const Mesh expected = test::reconstruct(settings_, frame);
        run(PlacedFrame(frame), expected);
        expect_equal(expected);
    }

private:
    void run(const PlacedFrame& placed, const Mesh& like) {
        mesh_.cell_size = like.cell_size;
        mesh_.offset_bits = like.offset_bits;
        statistics_ = {};
        backend_->reconstruct(placed, mesh_, statistics_).finish();
    }
    void expect_equal(const Mesh& expected) const {
        EXPECT_TRUE(test::same_bytes(mesh_.vertices, expected.vertices));
        EXPECT_TRUE(test::same_bytes(mesh_.normals, expected.normals));
        EXPECT_TRUE(test::same_bytes(mesh_.triangles, expected.triangles));
        EXPECT_TRUE(test::same_bytes(mesh_.bricks, expected.bricks));
    }

    Settings settings_;
    std::unique_ptr<BackendReconstruction> backend_;
    Mesh mesh_;
    Statistics statistics_;
};

TEST(PartsEmulated, GiveTheCpusMeshesAndSeams) {
    const test::Particles particles = test::splash(71, 8);
    for (const Mode mode : choices<Mode>) {
        Settings settings = test::default_settings();
        settings.cell_size = 0.25;
        settings.mode = mode;
        settings.spray = Spray::points;
        EmulatedParts device(settings);
        device.expect_the_cpus_parts(particles.frame(), 3, 4);
        device.expect_the_whole(particles.frame());
        device.expect_the_cpus_parts(particles.frame(), 2, 1);
    }
}

TEST(PartsEmulated, GiveTheCpusMeshesAndSeamsOfNoise) {
    const test::Particles particles = test::noise_cube(72, 1500, 0.5, 0.025);
    for (const Field field : choices<Field>) {
        Settings settings = test::default_settings();
        settings.field = field;
        settings.cell_size = 0.4;
        EmulatedParts(settings).expect_the_cpus_parts(particles.frame(), 2, 1);
    }
}

TEST(PartsEmulated, GiveTheCpusMeshesOfACroppedCountedFrame) {
    const test::Particles particles = test::splash(73, 7);
    Settings settings = test::default_settings();
    settings.cell_size = 0.25;
    settings.criterion = CountCriterion{};
    settings.edge_points = Bisection{};
    settings.domain = Box{{-0.1, -0.1, 0.05}, {0.25, 0.3, 9.0}};
    EmulatedParts(settings).expect_the_cpus_parts(particles.frame(), 3, 2);
}

}  // namespace
}  // namespace meniscus
