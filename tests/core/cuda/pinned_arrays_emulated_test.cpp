// Arrays in pinned memory go to and from a GPU without a copy on the way; those that cannot be pinned go as before.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cuda_runtime.h"
#include "engine/arrays.hpp"
#include "engine/cuda/pinned_memory.hpp"
#include "host_copies.hpp"
#include "meniscus/meniscus.hpp"
#include "pipeline/backend.hpp"
#include "support/overlap.hpp"
#include "support/particles.hpp"
#include "support/same_bytes.hpp"

namespace meniscus {
namespace {

/// A large enough mesh for its arrays to be pinned.
Settings fine() {
    Settings settings = test::default_settings();
    settings.field = Field::color;
    settings.cell_size = 0.2;
    return settings;
}

using test::overlaps;

class PinnedArrays : public testing::Test {
protected:
    ~PinnedArrays() override {
        emulated_device::on_copy = nullptr;
        emulated_device::before_copy_to_host = nullptr;
        emulated_device::register_status = cudaSuccess;
        emulated_device::unregister_status = cudaSuccess;
        cuda::pages_are_lost = false;
    }

    void reconstruct(const ParticleFrame& frame) {
        Statistics statistics;
        download = device->reconstruct(frame, mesh, statistics);
    }
    void expect_the_cpus_mesh() {
        download.finish();
        const Mesh expected = test::reconstruct(fine(), particles.frame());
        EXPECT_TRUE(test::same_bytes(mesh.vertices, expected.vertices));
        EXPECT_TRUE(test::same_bytes(mesh.normals, expected.normals));
        EXPECT_TRUE(test::same_bytes(mesh.triangles, expected.triangles));
        EXPECT_TRUE(test::same_bytes(mesh.bricks, expected.bricks));
    }
    /// A mesh that is charged as a reconstructor's meshes are.
    void adopt_mesh() {
        mesh.vertices = Array<LatticePosition>(AccountAllocator<LatticePosition>(account));
        mesh.normals = Array<Normal>(AccountAllocator<Normal>(account));
        mesh.triangles = Array<Triangle>(AccountAllocator<Triangle>(account));
        mesh.bricks = Array<MeshBrick>(AccountAllocator<MeshBrick>(account));
    }

    std::vector<std::string> refusals;
    const std::shared_ptr<PagePinning> pinning =
        cuda::page_pinning(0, [this](const std::string& reason) { refusals.push_back(reason); });
    const std::shared_ptr<MemoryAccount> account = std::make_shared<MemoryAccount>(0, "in memory", nullptr, pinning);
    const std::shared_ptr<MemoryAccount> device_account = std::make_shared<MemoryAccount>(0, "on the GPU");
    std::unique_ptr<BackendReconstruction> device =
        cuda::make_reconstruction(fine(), BackendOptions{}, account, device_account);
    const test::Particles particles = test::splash(4, 7);
    Mesh mesh;
    MeshDownload download;  // ends before the mesh
};

TEST_F(PinnedArrays, AMeshComesDownToThemWithoutACopyOnTheWay) {
    adopt_mesh();
    std::size_t straight = 0;
    for (int frame = 0; frame < 3; ++frame) {
        reconstruct(particles.frame());
        ASSERT_GE(mesh.triangles.size() * sizeof(Triangle), PagePinning::least_bytes);
        straight = 0;
        emulated_device::on_copy = [&](const void* to, const void*, std::size_t bytes, cudaMemcpyKind) {
            if (overlaps(mesh.triangles, to, bytes) || overlaps(mesh.vertices, to, bytes)) straight += bytes;
            return cudaSuccess;
        };
        expect_the_cpus_mesh();
        emulated_device::on_copy = nullptr;
        EXPECT_EQ(straight, mesh.triangles.size() * sizeof(Triangle) + mesh.vertices.size() * sizeof(LatticePosition));
    }
    EXPECT_TRUE(refusals.empty());
}

TEST_F(PinnedArrays, WhereMemoryCannotBePinnedTheMeshComesDownAsBeforeAndThatIsToldOnce) {
    emulated_device::register_status = cudaErrorMemoryAllocation;
    adopt_mesh();
    for (int frame = 0; frame < 3; ++frame) {
        reconstruct(particles.frame());
        emulated_device::on_copy = [&](const void* to, const void*, std::size_t bytes, cudaMemcpyKind) {
            EXPECT_FALSE(overlaps(mesh.triangles, to, bytes));
            return cudaSuccess;
        };
        expect_the_cpus_mesh();
        emulated_device::on_copy = nullptr;
        mesh = {};
        download = {};
        adopt_mesh();
    }
    ASSERT_EQ(refusals.size(), 1U);
    EXPECT_EQ(refusals[0], "out of memory");
}

TEST_F(PinnedArrays, NothingIsWrittenToAMeshAfterItsDownloadHasFailed) {
    adopt_mesh();
    reconstruct(particles.frame());
    int copies = 0;
    // The vertices are on their way by then.
    emulated_device::before_copy_to_host = [&] { return ++copies == 3 ? cudaErrorLaunchFailure : cudaSuccess; };
    EXPECT_THROW(download.start(), DeviceError);
    emulated_device::before_copy_to_host = nullptr;
    const LatticePosition mark{1, 2, 3};
    std::fill(mesh.vertices.begin(), mesh.vertices.end(), mark);
    device.reset();  // works off the rest on its streams
    download = {};
    EXPECT_TRUE(std::ranges::all_of(mesh.vertices, [&](const LatticePosition& v) { return v == mark; }));
}

TEST_F(PinnedArrays, ParticlesGoUpFromThemWithoutACopyOnTheWay) {
    const ParticleFrame frame = particles.frame();
    Array<float> positions{AccountAllocator<float>(std::make_shared<MemoryAccount>())};
    positions.assign(frame.positions.begin(), frame.positions.end());
    pinning->pin(positions.data(), positions.size() * sizeof(float));
    ParticleFrame pinned = frame;
    pinned.positions = positions;
    for (const ParticleFrame& each : {pinned, frame}) {
        bool straight = false;
        emulated_device::on_copy = [&](const void*, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
            if (kind == cudaMemcpyHostToDevice && overlaps(each.positions, from, bytes)) straight = true;
            return cudaSuccess;
        };
        reconstruct(each);
        emulated_device::on_copy = nullptr;
        EXPECT_EQ(straight, each.positions.data() == positions.data());
        expect_the_cpus_mesh();
    }
    pinning->unpin(positions.data());
}

TEST_F(PinnedArrays, OnceADeviceIsLostWithPagesThatWerePinnedForItNothingGoesStraight) {
    test::Particles own = particles;
    const std::size_t bytes = own.positions.size() * sizeof(float);
    pinning->pin(own.positions.data(), bytes);
    emulated_device::unregister_status = cudaErrorLaunchFailure;
    pinning->unpin(own.positions.data());
    emulated_device::unregister_status = cudaSuccess;
    // For CUDA these positions are pinned, as any others are that come to lie there.
    bool straight = false;
    emulated_device::on_copy = [&](const void*, const void* from, std::size_t copied, cudaMemcpyKind kind) {
        if (kind == cudaMemcpyHostToDevice && overlaps(own.positions, from, copied)) straight = true;
        return cudaSuccess;
    };
    reconstruct(own.frame());
    emulated_device::on_copy = nullptr;
    EXPECT_FALSE(straight);
    expect_the_cpus_mesh();
    EXPECT_EQ(device->sender()->send(own.frame()), 0U);
    std::vector<std::byte> other(PagePinning::least_bytes);
    pinning->pin(other.data(), other.size());
    EXPECT_EQ(refusals.size(), 1U);
    cudaHostUnregister(own.positions.data());
}

/// So may arrays be whose first and last pages are pinned for others beside them.
struct PinnedEnds {
    PinnedEnds(PagePinning& by, std::span<std::byte> array)
        : pinning(by), first(array.first(64)), last(array.last(64)) {
        for (const auto& end : {first, last}) pinning.pin(end.data(), end.size());
    }
    ~PinnedEnds() {
        for (const auto& end : {first, last}) pinning.unpin(end.data());
    }
    PinnedEnds(const PinnedEnds&) = delete;
    PinnedEnds& operator=(const PinnedEnds&) = delete;

    PagePinning& pinning;
    std::span<std::byte> first, last;
};

TEST_F(PinnedArrays, ArraysOfWhichOnlyTheEndsArePinnedGoAsThoseThatAreNot) {
    test::Particles own = particles;
    const PinnedEnds of_positions(*pinning, std::as_writable_bytes(std::span(own.positions)));
    EXPECT_EQ(device->sender()->send(own.frame()), 0U);
    reconstruct(own.frame());
    const PinnedEnds of_triangles(*pinning, std::as_writable_bytes(std::span(mesh.triangles)));
    expect_the_cpus_mesh();
    EXPECT_EQ(device->sender()->send(own.frame()), 0U) << "although there is an area";
    reconstruct(own.frame());
    expect_the_cpus_mesh();
}

TEST(PinnedGrowth, ALargeArrayThatGrowsSlowlyIsPinnedOnceInManyFrames) {
    struct CountedPinning final : PagePinning {
        void pin(void*, std::size_t) noexcept override { ++pins; }
        void unpin(void*) noexcept override {}
        int pins = 0;
    };
    const auto pinning = std::make_shared<CountedPinning>();
    const auto pinned = std::make_shared<MemoryAccount>(0, "in memory", nullptr, pinning);
    const auto others = std::make_shared<MemoryAccount>();
    Array<std::byte> array{AccountAllocator<std::byte>(pinned)};
    Array<std::byte> other{AccountAllocator<std::byte>(others)};
    constexpr std::size_t large = std::size_t{40} << 20;
    for (std::size_t tenths = 10; tenths <= 15; ++tenths) {
        resize_for_overwrite(array, large * tenths / 10);
        resize_for_overwrite(other, large * tenths / 10);
    }
    EXPECT_EQ(pinning->pins, 1);
    EXPECT_GT(others->allocations(), 2U) << "memory that is not pinned is kept small";
    resize_for_overwrite(array, 2 * large);
    EXPECT_EQ(pinning->pins, 2);
}

}  // namespace
}  // namespace meniscus
