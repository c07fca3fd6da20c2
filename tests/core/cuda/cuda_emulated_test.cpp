// The CUDA backend's kernels, run by a device in software, give the CPU's mesh to the bit. (cuda_test.cpp has the tests
// that need a GPU.)
#include <gtest/gtest.h>

#include "meniscus/meniscus.hpp"
#include "particles/warnings.hpp"
#include "pipeline/backend.hpp"
#include "support/particles.hpp"
#include "support/same_bytes.hpp"

namespace meniscus {
namespace {

class EmulatedDevice {
public:
    explicit EmulatedDevice(const Settings& settings, std::size_t limit = 0)
        : settings_(settings),
          device_account_(std::make_shared<MemoryAccount>(limit, "on the GPU")),
          backend_(cuda::make_reconstruction(settings, BackendOptions{}, std::make_shared<MemoryAccount>(),
                                             device_account_)) {}

    void expect_the_cpus_mesh(const ParticleFrame& frame) {
        const Mesh expected = test::reconstruct(settings_, frame);
        mesh_.cell_size = expected.cell_size;
        mesh_.offset_bits = expected.offset_bits;
        statistics_ = {};
        backend_->reconstruct(frame, mesh_, statistics_).finish();
        expect_equal(expected);
        Reconstructor cpu(settings_, {Backend::cpu, 1, 0});
        Mesh again;
        cpu.reconstruct(frame, again);
        EXPECT_TRUE(test::same_bytes(mesh_.spray, again.spray));
        EXPECT_EQ(statistics_.spray_particles, cpu.statistics().spray_particles);
        EXPECT_EQ(statistics_.field_evaluations, cpu.statistics().field_evaluations);
        EXPECT_EQ(statistics_.base_cells_by_level, cpu.statistics().base_cells_by_level);
        EXPECT_EQ(statistics_.volume, cpu.statistics().volume);
        statistics_.triangles = mesh_.triangles.size();
        find_warnings(
            frame, count_levels(frame), settings_, find_wrong_radius(frame, settings_),
            [this] { return backend_->greatest_sample(); }, statistics_);
        EXPECT_EQ(statistics_.warnings, cpu.statistics().warnings);
        for (const int max_level : {1, 3, 2}) {
            SCOPED_TRACE(testing::Message() << "levels up to " << max_level);
            cpu.emit_capped(max_level, again);
            backend_->emit_capped(max_level, mesh_);
            expect_equal(again);
        }
    }

    void expect_a_refusal(const ParticleFrame& frame) {
        EXPECT_THROW(static_cast<void>(backend_->reconstruct(frame, mesh_, statistics_)), LimitExceeded);
    }

    const std::vector<Warning>& warnings() const { return statistics_.warnings; }
    const MemoryAccount& device_account() const { return *device_account_; }

private:
    void expect_equal(const Mesh& expected) const {
        EXPECT_EQ(mesh_sha256(mesh_), mesh_sha256(expected));
        EXPECT_TRUE(test::same_bytes(mesh_.vertices, expected.vertices));
        EXPECT_TRUE(test::same_bytes(mesh_.normals, expected.normals));
        EXPECT_TRUE(test::same_bytes(mesh_.triangles, expected.triangles));
        EXPECT_TRUE(test::same_bytes(mesh_.bricks, expected.bricks));
        for (std::size_t l = 0; l < triangle_level_count; ++l)
            EXPECT_EQ(mesh_.levels[l].first, expected.levels[l].first);
    }

    Settings settings_;
    std::shared_ptr<MemoryAccount> device_account_;
    std::unique_ptr<BackendReconstruction> backend_;
    Mesh mesh_;
    Statistics statistics_;
};

TEST(CudaEmulated, GivesTheCpusMeshForASplash) {
    const test::Particles particles = test::splash(3, 8);
    for (const Field field : {Field::color, Field::density, Field::smooth})
        for (const Mode mode : {Mode::adaptive, Mode::uniform})
            for (const EdgePoints& edge_points : choices<EdgePoints>) {
                SCOPED_TRACE(testing::Message()
                             << name_of(field) << ", " << name_of(mode) << ", " << name_of(edge_points));
                Settings settings = test::default_settings();
                settings.field = field;
                settings.mode = mode;
                settings.edge_points = edge_points;
                EmulatedDevice(settings).expect_the_cpus_mesh(particles.frame());
            }
}

TEST(CudaEmulated, GivesTheCpusMeshForAdversarialParticles) {
    const Settings settings = test::default_settings();
    EmulatedDevice device(settings);
    for (const test::NamedParticles& named : test::adversarial(0.025F)) {
        SCOPED_TRACE(named.name);
        device.expect_the_cpus_mesh(named.particles.frame());
    }
}

TEST(CudaEmulated, GivesTheCpusMeshForOtherSettings) {
    const test::Particles particles = test::splash(4, 6);
    for (const double cell_size : {0.3, 1.0, 1.37})
        for (const double smoothing_length : {1.1, 2.0}) {
            SCOPED_TRACE(testing::Message() << cell_size << " " << smoothing_length);
            Settings settings = test::default_settings();
            settings.field = Field::color;
            settings.cell_size = cell_size;
            settings.smoothing_length = smoothing_length;
            EmulatedDevice(settings).expect_the_cpus_mesh(particles.frame());
            settings.criterion = CountCriterion{};
            EmulatedDevice(settings).expect_the_cpus_mesh(particles.frame());
        }
    for (const std::uint32_t smoothness : {5U, 6U, 7U})
        for (const double cell_size : {0.3, 1.0}) {
            SCOPED_TRACE(testing::Message() << "smoothness " << smoothness << " " << cell_size);
            Settings settings = test::default_settings();
            settings.smoothness = smoothness;
            settings.cell_size = cell_size;
            EmulatedDevice(settings).expect_the_cpus_mesh(particles.frame());
        }
}

TEST(CudaEmulated, GivesTheCpusMeshAndSpray) {
    test::Particles particles = test::splash(6, 6);
    for (int row = 0; row < 6; ++row)
        for (int i = 0; i < 7; ++i)
            particles.add(1.0F + 0.2F * static_cast<float>(i), 0.3F * static_cast<float>(row), -0.5F);
    Settings settings = test::default_settings();
    for (const Spray spray : choices<Spray>) {
        SCOPED_TRACE(name_of(spray));
        settings.spray = spray;
        EmulatedDevice(settings).expect_the_cpus_mesh(particles.frame());
        for (std::size_t i = particles.levels.size(); i < particles.count(); ++i)
            particles.levels.push_back(static_cast<std::uint8_t>(i % 3));
        EmulatedDevice(settings).expect_the_cpus_mesh(particles.frame());
        particles.levels.clear();
    }
}

TEST(CudaEmulated, GivesTheCpusMeshForParticleLevelsDomainsAndQuantizedPositions) {
    test::Particles particles = test::splash(5, 8);
    Settings settings = test::default_settings();
    settings.domain = Box{{0.05, 0.02, 0.03}, {0.31, 0.17, 0.33}};
    EmulatedDevice(settings).expect_the_cpus_mesh(particles.frame());

    std::vector<std::uint16_t> quantized;
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
        quantized.push_back(static_cast<std::uint16_t>(i * 7919 % 65536));
    ParticleFrame frame;
    frame.quantized = quantized;
    frame.quantization_box = {{-0.1, 0.2, -0.3}, {0.4, 0.6, 0.5}};
    settings.domain.reset();
    EmulatedDevice(settings).expect_the_cpus_mesh(frame);

    for (std::size_t i = 0; i < particles.count(); ++i) particles.levels.push_back(i % 7 == 0 ? 2 : i % 3 == 0 ? 1 : 0);
    EmulatedDevice(settings).expect_the_cpus_mesh(particles.frame());
    settings.criterion = CountCriterion{};
    EmulatedDevice(settings).expect_the_cpus_mesh(particles.frame());
}

TEST(CudaEmulated, GivesTheCpusWarnings) {
    const test::Particles particles = test::splash(9, 6);
    const auto expect_codes = [&](const Settings& settings, const std::vector<WarningCode>& codes) {
        EmulatedDevice device(settings);
        device.expect_the_cpus_mesh(particles.frame());
        std::vector<WarningCode> given;
        for (const Warning& warning : device.warnings()) given.push_back(warning.code);
        EXPECT_EQ(given, codes);
    };
    for (const Field field : {Field::color, Field::density}) {
        SCOPED_TRACE(name_of(field));
        Settings settings = test::default_settings();
        settings.field = field;
        settings.iso = 4.0;
        expect_codes(settings, {WarningCode::empty_surface});
        settings.domain = Box{{0.05, 0.02, 0.03}, {0.31, 0.17, 0.33}};
        expect_codes(settings, {WarningCode::empty_surface});
    }
    Settings settings = test::default_settings();
    settings.field = Field::color;
    settings.smoothing_length = 1.2;
    settings.cell_size = 1.6;
    expect_codes(settings, {WarningCode::cell_size_too_large, WarningCode::support_too_small});
    settings = test::default_settings();
    settings.domain = Box{{9.0, 9.0, 9.0}, {10.0, 10.0, 10.0}};
    expect_codes(settings, {WarningCode::empty_surface});
    settings.domain.reset();
    settings.particle_radius *= 3.0;
    expect_codes(settings, {WarningCode::radius_too_large});
}

TEST(CudaEmulated, FindsTheCpusGreatestSampleOfASurface) {
    const test::Particles particles = test::splash(9, 6);
    Settings settings = test::default_settings();
    for (const auto& domain : {std::optional<Box>(), std::optional(Box{{0.05, 0.02, 0.03}, {0.31, 0.17, 0.33}})}) {
        settings.domain = domain;
        const auto cpu = cpu::make_reconstruction(settings, {Backend::cpu, 1}, std::make_shared<MemoryAccount>());
        const auto device = cuda::make_reconstruction(settings, BackendOptions{}, std::make_shared<MemoryAccount>(),
                                                      std::make_shared<MemoryAccount>());
        Mesh mesh;
        Statistics statistics;
        cpu->reconstruct(particles.frame(), mesh, statistics).finish();
        device->reconstruct(particles.frame(), mesh, statistics).finish();
        EXPECT_GT(cpu->greatest_sample(), 0.6F);
        EXPECT_EQ(device->greatest_sample(), cpu->greatest_sample());
        device->reconstruct(particles.frame(), mesh, statistics).finish();  // of a frame alone
        EXPECT_EQ(device->greatest_sample(), cpu->greatest_sample());
    }
}

TEST(CudaEmulated, GivesTheCpusMeshWithoutNormals) {
    Settings settings = test::default_settings();
    settings.normals = false;
    EmulatedDevice(settings).expect_the_cpus_mesh(test::splash(7, 6).frame());
}

TEST(CudaEmulated, RefusesParticlesThatCrowd) {
    EmulatedDevice device(test::default_settings());
    test::Particles crowd;
    for (int i = 0; i < 20'000; ++i) crowd.add(1e-7F * static_cast<float>(i), 0.0F, 0.0F);
    device.expect_a_refusal(crowd.frame());
    device.expect_the_cpus_mesh(test::splash(8, 5).frame());
}

TEST(CudaEmulated, SortsWholeKeysWhereACellIsFull) {
    EmulatedDevice device(test::default_settings());
    device.expect_the_cpus_mesh(test::splash(8, 5).frame());
    // In no order, and some of them in one place.
    test::Particles full = test::splash(8, 5);
    for (int i = 0; i < 600; ++i)
        full.add(0.5F + 1e-3F * static_cast<float>(i * 7919 % 211), 0.3F, 0.3F + 1e-3F * static_cast<float>(i % 2));
    device.expect_the_cpus_mesh(full.frame());
    device.expect_the_cpus_mesh(test::splash(8, 5).frame());
}

TEST(CudaEmulated, SortsByAsManyBitsAsParticlesLieApart) {
    EmulatedDevice device(test::default_settings());
    test::Particles apart = test::splash(8, 4);
    for (const float distance : {100.0F, 1e4F}) {
        for (const float sign : {-1.0F, 1.0F}) apart.add(sign * distance, -sign * distance, sign * distance);
        device.expect_the_cpus_mesh(apart.frame());
    }
    device.expect_the_cpus_mesh(test::splash(8, 4).frame());
}

TEST(CudaEmulated, FramesThatGrowAndShrinkAreReplayedFromAGraph) {
    EmulatedDevice device(test::default_settings());
    for (const int side : {6, 6, 6, 10, 4, 4, 10, 10}) device.expect_the_cpus_mesh(test::splash(6, side).frame());
    const std::uint64_t allocations = device.device_account().allocations();
    device.expect_the_cpus_mesh(test::splash(6, 10).frame());
    EXPECT_EQ(device.device_account().allocations(), allocations);
    device.expect_the_cpus_mesh(ParticleFrame{});
}

TEST(CudaEmulated, TheFirstFrameFindsItsRoomInFewRuns) {
    Settings settings = test::default_settings();
    settings.cell_size = 1.0;
    EmulatedDevice device(settings);
    device.expect_the_cpus_mesh(test::splash(6, 20).frame());
    EXPECT_LE(device.device_account().allocations(), 6U)
        << "for particles and a least mesh, blocks, samples, more samples, the mesh";
}

TEST(CudaEmulated, AFrameBeyondTheMemoryLimitIsRefusedBeforeItIsAllocated) {
    EmulatedDevice unlimited(test::default_settings());
    unlimited.expect_the_cpus_mesh(test::splash(6, 6).frame());
    const std::size_t limit = unlimited.device_account().peak_bytes();
    EmulatedDevice limited(test::default_settings(), limit);
    limited.expect_the_cpus_mesh(test::splash(6, 6).frame());
    limited.expect_a_refusal(test::splash(6, 16).frame());
    EXPECT_LE(limited.device_account().peak_bytes(), limit);
    EXPECT_LT(limited.device_account().bytes(), limit / 2)
        << "the room of the frame before, its mesh aside, is given back first";
}

}  // namespace
}  // namespace meniscus
