// The CUDA backend on a GPU: the CPU's mesh to the bit, memory limits, memory that does not grow. Skipped, saying why,
// where there is none.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <optional>
#include <thread>

#include "meniscus/meniscus.hpp"
#include "support/attributes.hpp"
#include "support/particles.hpp"
#include "support/same_bytes.hpp"

namespace meniscus {
namespace {

/// The reason why there is no GPU; empty if there is one.
std::string reason_without_gpu() {
    const BackendDescription description = describe_backend(Backend::automatic);
    return description.backend == Backend::cuda ? std::string() : description.reason;
}

class NeedsGpu : public testing::Test {
protected:
    void SetUp() override {
        if (const std::string reason = reason_without_gpu(); !reason.empty()) GTEST_SKIP() << reason;
    }

    /// One frame after the other through one reconstructor.
    static void expect_the_cpus_mesh(const Settings& settings, const std::vector<ParticleFrame>& frames) {
        Reconstructor gpu(settings, {Backend::cuda, 0, 0});
        Mesh mesh;
        for (std::size_t i = 0; i < frames.size(); ++i) {
            SCOPED_TRACE(testing::Message() << "frame " << i);
            const Mesh expected = test::reconstruct(settings, frames[i]);
            gpu.reconstruct(frames[i], mesh);
            EXPECT_EQ(mesh_sha256(mesh), mesh_sha256(expected));
            EXPECT_TRUE(test::same_bytes(mesh.vertices, expected.vertices));
            EXPECT_TRUE(test::same_bytes(mesh.normals, expected.normals));
            EXPECT_TRUE(test::same_bytes(mesh.triangles, expected.triangles));
            EXPECT_TRUE(test::same_bytes(mesh.bricks, expected.bricks));
        }
    }
};

/// Small enough for compute-sanitizer.
class CudaSmall : public NeedsGpu {};
class Cuda : public NeedsGpu {};

TEST_F(CudaSmall, GivesTheCpusMeshForEveryModeCriterionFieldAndEdgePoint) {
    const test::Particles particles = test::splash(3, 6);
    for (const Field field : {Field::color, Field::density, Field::smooth})
        for (const Mode mode : {Mode::adaptive, Mode::uniform})
            for (const Criterion& criterion : choices<Criterion>)
                for (const EdgePoints& edge_points : choices<EdgePoints>) {
                    SCOPED_TRACE(testing::Message() << name_of(field) << ", " << name_of(mode) << ", "
                                                    << name_of(criterion) << ", " << name_of(edge_points));
                    Settings settings = test::default_settings();
                    settings.field = field;
                    settings.mode = mode;
                    settings.criterion = criterion;
                    settings.edge_points = edge_points;
                    // Grown, run launch by launch, captured, replayed.
                    expect_the_cpus_mesh(settings, std::vector<ParticleFrame>(4, particles.frame()));
                }
}

TEST_F(CudaSmall, GivesTheCpusMeshForParticleLevelsQuantizedPositionsAndDomains) {
    test::Particles particles = test::splash(4, 6);
    const test::Particles uniform = particles;
    for (std::size_t i = 0; i < particles.count(); ++i) particles.levels.push_back(i % 7 == 0 ? 2 : i % 3 == 0 ? 1 : 0);
    std::vector<std::uint16_t> quantized;
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
        quantized.push_back(static_cast<std::uint16_t>(i * 7919 % 65536));
    ParticleFrame frame;
    frame.quantized = quantized;
    frame.quantization_box = {{-0.1, 0.2, -0.3}, {0.4, 0.6, 0.5}};
    Settings settings = test::default_settings();
    expect_the_cpus_mesh(settings, {particles.frame(), frame, uniform.frame(), ParticleFrame{}, particles.frame()});
    settings.domain = Box{{0.05, 0.02, 0.03}, {0.21, 0.17, 0.23}};
    expect_the_cpus_mesh(settings, {particles.frame(), frame});
}

TEST_F(CudaSmall, GivesTheCpusMeshForAdversarialParticles) {
    const std::vector<test::NamedParticles> all = test::adversarial(0.025F);
    std::vector<ParticleFrame> frames;
    for (const test::NamedParticles& named : all) frames.push_back(named.particles.frame());
    expect_the_cpus_mesh(test::default_settings(), frames);
}

TEST_F(CudaSmall, PacksTheCpusBricks) {
    test::ParticlesWithArrays particles = test::with_noise(test::splash(5, 8), 1);
    for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
        SCOPED_TRACE(name_of(mode));
        Settings settings = test::default_settings();
        settings.mode = mode;
        settings.all_attributes = true;
        Reconstructor gpu(settings, {.backend = Backend::cuda, .keep_lattice = true});
        Reconstructor cpu(settings, {.backend = Backend::cpu, .keep_lattice = true});
        Mesh mesh, expected;
        cpu.reconstruct(particles.frame(), expected);
        for (int round = 0; round < 4; ++round) {  // grown, run launch by launch, captured, replayed
            const MeshDownload download = gpu.reconstruct_for_download(particles.frame(), mesh);
            const std::vector<AttributeRange> ranges = download.attribute_ranges(mesh);
            EXPECT_EQ(ranges, attribute_ranges(expected));
            const std::vector<AttributeWish> all{{.name = {}, .bits = 8}};
            const CodingOptions options{.codec = Codec::lattice_packed,
                                        .attributes = coded_attributes(mesh, ranges, all)};
            const auto bricks = download.pack(mesh, options);
            ASSERT_NE(bricks, nullptr);
            ASSERT_EQ(mesh.bricks.size(), expected.bricks.size());
            for (std::size_t i = 0; i < expected.bricks.size(); ++i)
                EXPECT_EQ(bricks->bring(i).data, encode_brick(expected, i, options).data) << "brick " << i;
        }
    }
}

TEST_F(CudaSmall, GivesTheCpusAttributes) {
    test::ParticlesWithArrays particles = test::with_noise(test::splash(3, 8), 1);
    for (const Field field : choices<Field>) {
        SCOPED_TRACE(name_of(field));
        Settings settings = test::default_settings();
        settings.field = field;
        settings.all_attributes = true;
        Reconstructor gpu(settings, {Backend::cuda, 0, 0});
        Reconstructor cpu(settings, {Backend::cpu, 0, 0});
        Mesh mesh, expected;
        for (int round = 0; round < 4; ++round) {  // grown, run launch by launch, captured, replayed
            gpu.reconstruct(particles.frame(), mesh);
            cpu.reconstruct(particles.frame(), expected);
            EXPECT_TRUE(test::same_attributes(mesh, expected));
        }
        gpu.emit_capped(2, mesh);
        cpu.emit_capped(2, expected);
        EXPECT_TRUE(test::same_attributes(mesh, expected));
    }
}

TEST_F(Cuda, GivesTheCpusMeshForLargerSplashesAndOtherCells) {
    for (const double cell_size : {0.3, 0.5, 1.0, 1.37}) {
        SCOPED_TRACE(cell_size);
        Settings settings = test::default_settings();
        settings.cell_size = cell_size;
        const test::Particles first = test::splash(5, 24);
        const test::Particles second = test::splash(6, 30);
        expect_the_cpus_mesh(settings, {first.frame(), second.frame(), first.frame(), second.frame(), second.frame()});
    }
}

TEST_F(Cuda, SeveralReconstructorsShareADevice) {
    const Settings settings = test::default_settings();
    std::vector<Reconstructor> all;
    for (int i = 0; i < 4; ++i) all.emplace_back(settings, BackendOptions{Backend::cuda, 0, 0});
    for (unsigned round = 0; round < 3; ++round)
        for (unsigned i = 0; i < 4; ++i) {
            const test::Particles particles = test::splash(10 + i, 8 + 2 * static_cast<int>(i));
            Mesh mesh;
            all[i].reconstruct(particles.frame(), mesh);
            EXPECT_EQ(mesh_sha256(mesh), mesh_sha256(test::reconstruct(settings, particles.frame())));
        }
}

TEST_F(Cuda, ReconstructorsInSeveralThreadsShareADevice) {
    const Settings settings = test::default_settings();
    std::vector<test::Particles> splashes;
    std::vector<std::string> expected;
    for (unsigned i = 0; i < 4; ++i) {
        splashes.push_back(test::splash(20 + i, 8 + 4 * static_cast<int>(i)));
        expected.push_back(mesh_sha256(test::reconstruct(settings, splashes[i].frame())));
    }
    std::vector<std::string> hashes(4 * splashes.size());
    std::vector<std::thread> threads;
    for (std::size_t first = 0; first < splashes.size(); ++first)
        threads.emplace_back([&, first] {
            Reconstructor gpu(settings, {Backend::cuda, 0, 0});
            Mesh mesh;
            // Their frames grow, are captured and replayed while others do the same.
            for (std::size_t round = 0; round < 40; ++round) {
                const std::size_t i = (first + round / 10) % splashes.size();
                gpu.reconstruct(splashes[i].frame(), mesh);
                if (round % 10 == 9) hashes[4 * first + round / 10] = mesh_sha256(mesh);
            }
        });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t i = 0; i < hashes.size(); ++i) EXPECT_EQ(hashes[i], expected[(i / 4 + i % 4) % 4]) << i;
}

TEST_F(Cuda, AFrameThatFailsWhileItIsDownloadedIsRefusedAndTheNextOneWorks) {
    const Settings settings = test::default_settings();
    const test::Particles small = test::splash(42, 6);
    const test::Particles large = test::splash(42, 40);
    Mesh mesh;
    Reconstructor unlimited(settings, {Backend::cuda, 0, 0});
    unlimited.reconstruct(large.frame(), mesh);
    const std::size_t limit = unlimited.statistics().peak_bytes - mesh.triangles.size() * sizeof(Triangle) / 2;
    Reconstructor limited(settings, {Backend::cuda, 0, limit});
    EXPECT_THROW(limited.reconstruct(large.frame(), mesh), LimitExceeded);
    limited.reconstruct(small.frame(), mesh);
    EXPECT_EQ(mesh_sha256(mesh), mesh_sha256(test::reconstruct(settings, small.frame())));
}

TEST_F(Cuda, AFramePastTheDeviceMemoryLimitIsRefusedWithNumbersAndTheNextOneWorks) {
    const Settings settings = test::default_settings();
    const test::Particles small = test::splash(42, 6);
    const test::Particles large = test::splash(42, 40);
    Mesh mesh;
    Reconstructor unlimited(settings, {Backend::cuda, 0, 0});
    unlimited.reconstruct(small.frame(), mesh);
    const std::string expected = mesh_sha256(mesh);
    const std::size_t limit = 2 * unlimited.statistics().device_peak_bytes;
    Reconstructor limited(settings, {Backend::cuda, 0, 0, 0, limit});
    try {
        limited.reconstruct(large.frame(), mesh);
        FAIL() << "a frame beyond the limit was accepted";
    } catch (const LimitExceeded& e) {
        EXPECT_NE(std::string(e.what()).find(std::to_string(limit)), std::string::npos) << e.what();
    }
    EXPECT_TRUE(mesh.triangles.empty());
    limited.reconstruct(small.frame(), mesh);
    EXPECT_EQ(mesh_sha256(mesh), expected);
    EXPECT_LE(limited.statistics().device_peak_bytes, limit);
}

TEST_F(CudaSmall, TakesParticlesThatAreOnTheDevice) {
    // A mesh is there already: its normals serve as places on a sphere.
    Settings settings = test::default_settings();
    const test::Particles particles = test::splash(9, 5);
    Reconstructor maker(settings, {Backend::cuda, 0, 0});
    Mesh made;
    maker.reconstruct(particles.frame(), made);
    const DeviceMesh on_device = maker.reconstruct_on_device(particles.frame());
    ASSERT_EQ(on_device.vertex_count, made.normals.size());
    settings.particle_radius = 0.1;
    settings.cell_size = 1.0;
    ParticleFrame frame;
    frame.positions = {made.normals.front().data(), 3 * made.normals.size()};
    const std::string expected = mesh_sha256(test::reconstruct(settings, frame));

    Reconstructor gpu(settings, {Backend::cuda, 0, 0});
    const DeviceParticleFrame device_frame{on_device.normals->data(), on_device.vertex_count, nullptr,
                                           on_device.stream};
    Mesh mesh;
    for (int round = 0; round < 4; ++round) {  // grown, run launch by launch, captured, replayed
        gpu.reconstruct(device_frame, mesh);
        EXPECT_EQ(mesh_sha256(mesh), expected);
    }
    EXPECT_EQ(gpu.reconstruct_on_device(device_frame).triangle_count, mesh.triangles.size());
    EXPECT_THROW(gpu.reconstruct(DeviceParticleFrame{frame.positions.data(), frame.count()}, mesh), InvalidInput)
        << "memory of the host";
    gpu.reconstruct(device_frame, mesh);
    EXPECT_EQ(mesh_sha256(mesh), expected);
}

TEST_F(Cuda, TheMeshOnTheDeviceIsTheOneThatIsDownloaded) {
    const test::Particles particles = test::splash(7);
    Reconstructor gpu(test::default_settings(), {Backend::cuda, 0, 0});
    Mesh mesh;
    gpu.reconstruct(particles.frame(), mesh);
    const DeviceMesh on_device = gpu.reconstruct_on_device(particles.frame());
    EXPECT_EQ(on_device.vertex_count, mesh.vertices.size());
    EXPECT_EQ(on_device.triangle_count, mesh.triangles.size());
    EXPECT_EQ(on_device.offset_bits, mesh.offset_bits);
    EXPECT_NE(on_device.triangles, nullptr);
    EXPECT_EQ(gpu.statistics().triangles, mesh.triangles.size());
}

TEST_F(Cuda, AFrameThatIsPackedOnTheDeviceHasTheCpusBricks) {
    const test::Particles particles = test::splash(7, 10);
    BackendOptions options{Backend::cuda, 0, 0};
    options.keep_lattice = true;
    Reconstructor gpu(test::default_settings(), options);
    static_cast<void>(gpu.reconstruct_on_device(particles.frame()));
    const DevicePackedFrame frame = gpu.pack_on_device({.normal_bits = 0});
    options.backend = Backend::cpu;
    Mesh mesh;
    Reconstructor(test::default_settings(), options).reconstruct(particles.frame(), mesh);
    ASSERT_EQ(frame.bricks.size(), mesh.bricks.size());
    for (std::size_t i = 0; i < frame.bricks.size(); ++i)
        EXPECT_EQ(frame.memory->bring(i).data,
                  encode_brick(mesh, i, {.normal_bits = 0, .codec = Codec::lattice_packed}).data);
}

TEST_F(Cuda, EveryStageOfAWarmFrameIsTimedAndNothingIsAllocated) {
    const test::Particles particles = test::splash(8, 20);
    Reconstructor gpu(test::default_settings(), {Backend::cuda, 0, 0});
    Mesh mesh;
    for (int i = 0; i < 4; ++i) gpu.reconstruct(particles.frame(), mesh);
    EXPECT_EQ(gpu.statistics().allocations, 0U);
    EXPECT_GT(gpu.statistics().device_bytes, 0U);
    for (const Stage stage : choices<Stage>)
        EXPECT_GT(gpu.statistics().stage_seconds[static_cast<std::size_t>(stage)], 0.0) << name_of(stage);
}

TEST_F(Cuda, ThousandFramesDoNotGrowDeviceMemory) {
    std::vector<test::Particles> splashes;
    for (unsigned seed = 0; seed < 4; ++seed) splashes.push_back(test::splash(seed, 16));
    Reconstructor gpu(test::default_settings(), {Backend::cuda, 0, 0});
    Mesh mesh;
    std::optional<std::size_t> free_bytes;
    for (unsigned frame = 0; frame < 1000; ++frame) {
        gpu.reconstruct(splashes[frame % splashes.size()].frame(), mesh);
        if (frame < 100) continue;
        ASSERT_EQ(gpu.statistics().allocations, 0U) << frame;
        if (!free_bytes) free_bytes = cuda::devices().at(0).free_bytes;
    }
    EXPECT_GE(cuda::devices().at(0).free_bytes, *free_bytes);
}

TEST(CudaWithoutGpu, AMissingDriverIsSaidPlainly) {
    const bool has_driver = dlopen("libcuda.so.1", RTLD_LAZY) != nullptr;
    EXPECT_EQ(describe_backend(Backend::automatic).reason == "no NVIDIA driver found", !has_driver)
        << describe_backend(Backend::automatic).reason;
}

TEST(CudaWithoutGpu, TheCpuBackendHasNoMeshOnADeviceAndSaysSo) {
    Reconstructor cpu(test::default_settings(), {Backend::cpu, 1, 0});
    EXPECT_THROW(static_cast<void>(cpu.reconstruct_on_device(test::splash(1, 4).frame())), InvalidInput);
}

}  // namespace
}  // namespace meniscus
