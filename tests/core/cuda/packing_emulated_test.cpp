// Bricks that the CUDA backend's kernels pack, on the device in software: the CPU's bytes, and nothing else comes down.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "cuda_runtime.h"
#include "meniscus/meniscus.hpp"
#include "particles/attribute_choice.hpp"
#include "pipeline/backend.hpp"
#include "support/attributes.hpp"
#include "support/golden_rows.hpp"
#include "support/golden_scenes.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

constexpr LatticePosition untouched{-1, -2, -3};

CodingOptions packed(CodingOptions options = {}) {
    options.codec = Codec::lattice_packed;
    return options;
}

/// The part of a Reconstructor around the backend, and the CPU beside it.
class PackingDevice {
public:
    explicit PackingDevice(const Settings& settings, std::size_t limit = 0, bool keeps_lattice = true)
        : choice_(settings),
          cpu_(settings, {.backend = Backend::cpu, .threads = 1, .keep_lattice = true}),
          device_account_(std::make_shared<MemoryAccount>(limit, "on the GPU")),
          backend_(cuda::make_reconstruction(settings, {.keep_lattice = keeps_lattice}, account_, device_account_)) {
        mesh.cell_size = world_cell_size(settings);
        mesh.offset_bits = offset_bits(settings);
    }

    /// The mesh waits on the device.
    void reconstruct(const ParticleFrame& frame) {
        reconstruct(frame, [&](const PlacedFrame& placed) {
            Statistics statistics;
            download = backend_->reconstruct(placed, mesh, statistics);
            std::ranges::fill(mesh.vertices, untouched);
        });
    }
    /// It stays there.
    void reconstruct_on_device(const ParticleFrame& frame) {
        reconstruct(frame, [&](const PlacedFrame& placed) {
            Statistics statistics;
            static_cast<void>(backend_->reconstruct_on_device(placed, statistics));
        });
    }
    template <class Call>
    void reconstruct(const ParticleFrame& frame, const Call& call) {
        download = {};
        cpu_.reconstruct(frame, expected);
        mesh.clear();
        const std::vector<ParticleArray> chosen = choice_.of(frame);
        PlacedFrame placed(frame);
        placed.frame.arrays = chosen;
        placed.attributes = numbers_in_host_memory(chosen);
        choice_.keep(chosen);
        choice_.shape(mesh, account_);
        call(placed);
    }
    DevicePackedFrame pack_on_device(const CodingOptions& options, std::span<const AttributeWish> wishes = {}) {
        Mesh described;
        described.cell_size = mesh.cell_size;
        described.offset_bits = mesh.offset_bits;
        choice_.shape(described, account_);
        DevicePackedFrame frame;
        backend_->pack_on_device(described, options, wishes, frame);
        return frame;
    }

    void expect_the_cpus_bricks(const CodingOptions& options) {
        const auto bricks = download.pack(mesh, packed(options));
        ASSERT_NE(bricks, nullptr);
        ASSERT_EQ(mesh.bricks.size(), expected.bricks.size());
        BrickScratch scratch;
        for (std::size_t i = 0; i < expected.bricks.size(); ++i) {
            const DeviceBytes there = bricks->on_device(i);
            const EncodedBrick brick = bricks->bring(i);
            const EncodedBrick of_cpu = encode_brick(expected, i, packed(options));
            ASSERT_EQ(brick.coordinate, of_cpu.coordinate);
            ASSERT_EQ(brick.vertices, of_cpu.vertices);
            ASSERT_EQ(brick.triangles, of_cpu.triangles);
            ASSERT_EQ(brick.data, of_cpu.data) << "brick " << i;
            ASSERT_TRUE(std::ranges::equal(std::span(there.data, there.size), of_cpu.data)) << "brick " << i;
        }
        EXPECT_TRUE(std::ranges::all_of(mesh.vertices, [](const auto& v) { return v == untouched; }));
    }
    void expect_the_cpus_bricks_of(const ParticleFrame& frame, const CodingOptions& options = {}) {
        reconstruct(frame);
        expect_the_cpus_bricks(options);
    }

    Reconstructor& cpu() { return cpu_; }
    BackendReconstruction& backend() { return *backend_; }
    const MemoryAccount& device_account() const { return *device_account_; }

    Mesh expected;
    Mesh mesh;
    MeshDownload download;  // ends before the mesh

private:
    AttributeChoice choice_;
    Reconstructor cpu_;
    std::shared_ptr<MemoryAccount> account_ = std::make_shared<MemoryAccount>();
    std::shared_ptr<MemoryAccount> device_account_;
    std::unique_ptr<BackendReconstruction> backend_;
};

TEST(PackingEmulated, GivesTheCpusBricksForAllFieldsModesAndBits) {
    const test::Particles particles = test::splash(3, 8);
    for (const Field field : choices<Field>)
        for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
            SCOPED_TRACE(testing::Message() << name_of(field) << ", " << name_of(mode));
            Settings settings = test::default_settings();
            settings.field = field;
            settings.mode = mode;
            settings.cell_size = 0.5;
            PackingDevice device(settings);
            device.reconstruct(particles.frame());
            for (const int position_bits : {0, 2, 5})
                for (const int normal_bits : {0, 2, 8, 16})
                    device.expect_the_cpus_bricks({.normal_bits = normal_bits, .position_bits = position_bits});
        }
}

TEST(PackingEmulated, GivesTheCpusBricksForAdversarialParticles) {
    for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
        Settings settings = test::default_settings();
        settings.mode = mode;
        PackingDevice device(settings);
        for (const test::NamedParticles& named : test::adversarial(0.025F)) {
            SCOPED_TRACE(named.name);
            device.expect_the_cpus_bricks_of(named.particles.frame());
        }
        device.expect_the_cpus_bricks_of(ParticleFrame{});
    }
}

TEST(PackingEmulated, GivesTheCpusBricksForGoldenScenes) {
    const auto scenes = test::golden_scenes();
    for (const test::GoldenRow& row : test::golden_rows()) {
        if (row.max_level < 3) continue;
        SCOPED_TRACE(row.name);
        PackingDevice(row.settings())
            .expect_the_cpus_bricks_of(std::ranges::find(scenes, row.scene, &test::GoldenScene::name)->frame());
    }
}

TEST(PackingEmulated, GivesTheCpusBricksWithAttributesOfEveryForm) {
    test::ParticlesWithArrays particles = test::with_noise(test::splash(4, 6), 1);
    for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
        Settings settings = test::default_settings();
        settings.all_attributes = true;
        settings.mode = mode;
        PackingDevice device(settings);
        device.reconstruct(particles.frame());
        const std::vector<AttributeRange> ranges = device.download.attribute_ranges(device.mesh);
        EXPECT_EQ(ranges, attribute_ranges(device.expected));
        for (const int bits : {0, 5, 8, 13}) {
            SCOPED_TRACE(bits);
            const std::vector<AttributeWish> wishes{{.name = {}, .bits = bits}};
            device.expect_the_cpus_bricks({.attributes = coded_attributes(device.mesh, ranges, wishes)});
        }
        const std::vector<AttributeWish> one{{.name = device.mesh.attributes.back().name, .bits = 8}};
        device.expect_the_cpus_bricks({.normal_bits = 0, .attributes = coded_attributes(device.mesh, ranges, one)});
    }
}

TEST(PackingEmulated, GivesTheCpusBytesOfTheEntropyProfile) {
    test::ParticlesWithArrays particles = test::with_noise(test::splash(5, 8), 1);
    Settings settings = test::default_settings();
    settings.all_attributes = true;
    PackingDevice device(settings);
    device.reconstruct(particles.frame());
    CodingOptions options{.codec = Codec::lattice_entropy};
    const std::vector<AttributeWish> all{{.name = {}, .bits = 8}};
    options.attributes = coded_attributes(device.mesh, device.download.attribute_ranges(device.mesh), all);
    const auto bricks = device.download.pack(device.mesh, options);
    ASSERT_NE(bricks, nullptr);
    BrickScratch scratch;
    for (std::size_t i = 0; i < device.mesh.bricks.size(); ++i) {
        const EncodedBrick brick = PreparedBrick(*bricks, i, options, scratch).encode();
        EXPECT_EQ(brick.codec, Codec::lattice_entropy);
        EXPECT_EQ(brick.data, encode_brick(device.expected, i, options).data);
    }
}

TEST(PackingEmulated, GivesTheCpusBricksInFramesThatGrowShrinkAndAreReplayed) {
    PackingDevice device(test::default_settings());
    for (const int side : {6, 6, 6, 10, 4, 10, 10}) device.expect_the_cpus_bricks_of(test::splash(6, side).frame());
    const std::uint64_t allocations = device.device_account().allocations();
    device.expect_the_cpus_bricks_of(test::splash(6, 10).frame());
    EXPECT_EQ(device.device_account().allocations(), allocations);
}

TEST(PackingEmulated, AMeshThatComesDownHasItsLattice) {
    PackingDevice device(test::default_settings());
    const test::Particles particles = test::splash(7, 8);
    for (int round = 0; round < 2; ++round) {
        device.reconstruct(particles.frame());
        if (round == 1) device.expect_the_cpus_bricks({});
        device.download.finish();
        EXPECT_EQ(mesh_sha256(device.mesh), mesh_sha256(device.expected));
        EXPECT_EQ(device.download.pack(device.mesh, packed()), nullptr) << "it is the host's";
        for (std::size_t i = 0; i < device.expected.bricks.size(); ++i)
            EXPECT_EQ(encode_brick(device.mesh, i, packed()).data, encode_brick(device.expected, i, packed()).data);
        for (const int max_level : {2, 1}) {
            Mesh capped;
            device.cpu().emit_capped(max_level, capped);
            device.backend().emit_capped(max_level, device.mesh);
            ASSERT_EQ(device.mesh.bricks.size(), capped.bricks.size());
            for (std::size_t i = 0; i < capped.bricks.size(); ++i)
                EXPECT_EQ(encode_brick(device.mesh, i, packed()).data, encode_brick(capped, i, packed()).data);
        }
    }
}

TEST(PackingEmulated, OnlyBricksThatAreAskedForComeDown) {
    Settings settings = test::default_settings();
    settings.mode = Mode::uniform;
    settings.cell_size = 0.4;
    PackingDevice device(settings);
    device.reconstruct(test::splash(8, 10).frame());
    const auto bricks = device.download.pack(device.mesh, packed());
    ASSERT_GT(device.mesh.bricks.size(), 4U);
    for (std::size_t i = 1; i < device.mesh.bricks.size(); ++i) bricks->leave(i);
    int copies = 0;
    emulated_device::before_copy_to_host = [&] {
        ++copies;
        return cudaSuccess;
    };
    static_cast<void>(bricks->bring(0));
    static_cast<void>(bricks->bring(0));
    EXPECT_EQ(copies, 1);
    const EncodedBrick last = bricks->bring(device.mesh.bricks.size() - 1);
    EXPECT_EQ(copies, 2) << "it was left, and is asked for all the same";
    emulated_device::before_copy_to_host = nullptr;
    EXPECT_EQ(last.data, encode_brick(device.expected, device.mesh.bricks.size() - 1, packed()).data);
}

TEST(PackingEmulated, HashesDifferWhereContentDoes) {
    Settings settings = test::default_settings();
    settings.all_attributes = true;
    PackingDevice device(settings);
    const auto hashes = [&](test::Particles particles, float range, const CodingOptions& options = {}) {
        test::ParticlesWithArrays with;
        with.particles = std::move(particles);
        with.add_floats("speed", 1, [](std::size_t, std::size_t) { return 1.0F; });
        device.reconstruct(with.frame());
        CodingOptions coding = packed(options);
        coding.attributes = {{.name = "speed", .bits = 8, .minimum = {1.0F}, .maximum = {range}}};
        const auto bricks = device.download.pack(device.mesh, coding);
        std::vector<ContentHash> all;
        for (std::size_t i = 0; i < device.mesh.bricks.size(); ++i) all.push_back(bricks->hash(i));
        return all;
    };
    test::Particles particles = test::splash(9, 6);
    const std::size_t far = particles.positions.size();
    for (std::size_t i = 0; i < far; ++i) particles.positions.push_back(particles.positions[i] + 5.0F);
    const auto first = hashes(particles, 2.0F);
    EXPECT_EQ(hashes(particles, 2.0F), first);
    const auto other_range = hashes(particles, 4.0F);
    for (std::size_t i = 0; i < first.size(); ++i) EXPECT_NE(other_range[i], first[i]);
    test::Particles moved = particles;
    moved.positions[far] += 0.01F;
    const auto after = hashes(moved, 2.0F);
    ASSERT_EQ(after.size(), first.size());
    EXPECT_NE(after, first);
    EXPECT_TRUE(std::ranges::any_of(first, [&](const ContentHash& hash) {
        return std::ranges::find(after, hash) != after.end();
    })) << "bricks far from the particle stay the same";
}

TEST(PackingEmulated, PackedBricksOutliveTheirDownloadAndTheReconstruction) {
    auto device = std::make_unique<PackingDevice>(test::default_settings());
    device->reconstruct(test::splash(1, 8).frame());
    const Mesh expected = device->expected;
    const auto bricks = device->download.pack(device->mesh, packed());
    for (int i = 0; i < 3; ++i) device->reconstruct(test::splash(2, 6).frame());
    device.reset();
    for (std::size_t i = 0; i < expected.bricks.size(); ++i)
        EXPECT_EQ(bricks->bring(i).data, encode_brick(expected, i, packed()).data);
}

TEST(PackingEmulated, WhereNoRoomIsLeftTheMeshComesDownForTheHost) {
    const test::Particles particles = test::splash(1, 8);
    PackingDevice probe(test::default_settings());
    probe.reconstruct(particles.frame());
    PackingDevice device(test::default_settings(), probe.device_account().peak_bytes() + 1024);
    device.reconstruct(particles.frame());
    EXPECT_EQ(device.download.pack(device.mesh, packed()), nullptr);
    device.download.finish();
    for (std::size_t i = 0; i < device.expected.bricks.size(); ++i)
        EXPECT_EQ(encode_brick(device.mesh, i, packed()).data, encode_brick(device.expected, i, packed()).data);
}

TEST(PackingEmulated, WithoutItsLatticeAMeshIsNotPacked) {
    PackingDevice device(test::default_settings(), 0, false);
    device.reconstruct(test::splash(1, 6).frame());
    EXPECT_EQ(device.download.pack(device.mesh, packed()), nullptr);
    device.download.finish();
    EXPECT_TRUE(device.mesh.lattice.bricks.empty());
}

void expect_the_same_bricks(const DevicePackedFrame& frame, const Mesh& expected, const CodingOptions& options) {
    ASSERT_EQ(frame.bricks.size(), expected.bricks.size());
    for (std::size_t i = 0; i < frame.bricks.size(); ++i) {
        const DevicePackedBrick& brick = frame.bricks[i];
        const EncodedBrick of_cpu = encode_brick(expected, i, options);
        EXPECT_EQ(brick.coordinate, of_cpu.coordinate);
        EXPECT_EQ(brick.vertices, of_cpu.vertices);
        EXPECT_EQ(brick.triangles, of_cpu.triangles);
        // The device's memory is the host's.
        EXPECT_TRUE(std::ranges::equal(std::span(brick.bytes.data, brick.bytes.size), of_cpu.data)) << "brick " << i;
        EXPECT_EQ(frame.memory->bring(i).data, of_cpu.data);
    }
}

TEST(PackingEmulated, AFrameThatStaysOnTheDeviceHasTheCpusBricksThereWithoutACopyOfItsMesh) {
    test::ParticlesWithArrays particles = test::with_noise(test::splash(8, 8), 2);
    for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
        Settings settings = test::default_settings();
        settings.all_attributes = true;
        settings.mode = mode;
        PackingDevice device(settings);
        const std::vector<AttributeWish> all{{.name = {}, .bits = 8}};
        for (int round = 0; round < 3; ++round) {
            device.reconstruct_on_device(particles.frame());
            const DevicePackedFrame frame = device.pack_on_device({.normal_bits = 6}, all);
            EXPECT_EQ(frame.attributes, coded_attributes(device.expected, attribute_ranges(device.expected), all));
            expect_the_same_bricks(frame, device.expected, packed({.normal_bits = 6, .attributes = frame.attributes}));
            EXPECT_TRUE(device.mesh.vertices.empty());
        }
    }
}

TEST(PackingEmulated, AFrameThatWasPackedOnTheDeviceOutlivesTheNextAndTheReconstruction) {
    auto device = std::make_unique<PackingDevice>(test::default_settings());
    device->reconstruct_on_device(test::splash(1, 8).frame());
    const Mesh expected = device->expected;
    const DevicePackedFrame frame = device->pack_on_device({});
    for (int i = 0; i < 2; ++i) {
        device->reconstruct_on_device(test::splash(2, 6).frame());
        expect_the_same_bricks(device->pack_on_device({}), device->expected, packed());
    }
    device.reset();
    expect_the_same_bricks(frame, expected, packed());
}

TEST(PackingEmulated, WhatCannotBePackedOnTheDeviceIsRefusedAndTheMeshStays) {
    const test::Particles particles = test::splash(1, 8);
    PackingDevice without(test::default_settings(), 0, false);
    without.reconstruct_on_device(particles.frame());
    EXPECT_THROW(static_cast<void>(without.pack_on_device({})), InvalidInput);
    PackingDevice probe(test::default_settings());
    probe.reconstruct_on_device(particles.frame());
    PackingDevice device(test::default_settings(), probe.device_account().peak_bytes() + 1024);
    device.reconstruct_on_device(particles.frame());
    EXPECT_THROW(static_cast<void>(device.pack_on_device({})), LimitExceeded);
    Mesh capped;
    capped.cell_size = device.expected.cell_size;
    capped.offset_bits = device.expected.offset_bits;
    device.backend().emit_capped(3, capped);
    EXPECT_EQ(mesh_sha256(capped), mesh_sha256(device.expected));
    PackingDevice empty(test::default_settings());
    empty.reconstruct_on_device(ParticleFrame{});
    EXPECT_TRUE(empty.pack_on_device({}).bricks.empty());
}

TEST(PackingEmulated, OptionsOutOfRangeAreRefused) {
    PackingDevice device(test::default_settings());
    device.reconstruct(test::splash(1, 6).frame());
    EXPECT_EQ(device.download.pack(device.mesh, {.codec = Codec::draco}), nullptr);
    EXPECT_THROW(static_cast<void>(device.download.pack(device.mesh, packed({.normal_bits = 17}))), InvalidInput);
    EXPECT_THROW(static_cast<void>(device.download.pack(device.mesh, packed({.position_bits = 9}))), InvalidInput);
    CodingOptions unknown = packed();
    unknown.attributes = {{.name = "none"}};
    EXPECT_THROW(static_cast<void>(device.download.pack(device.mesh, unknown)), InvalidInput);
    device.expect_the_cpus_bricks({});
}

TEST(PackingEmulated, ADeviceThatFailsIsReportedAtEveryCall) {
    PackingDevice device(test::default_settings());
    device.reconstruct(test::splash(1, 6).frame());
    const auto bricks = device.download.pack(device.mesh, packed());
    emulated_device::before_copy_to_host = [] { return cudaErrorLaunchFailure; };
    EXPECT_THROW(static_cast<void>(bricks->bring(0)), DeviceError);
    emulated_device::before_copy_to_host = nullptr;
    EXPECT_THROW(static_cast<void>(bricks->bring(0)), DeviceError);
}

}  // namespace
}  // namespace meniscus
