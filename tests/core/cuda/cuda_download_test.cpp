// Meshes that come down while later frames are reconstructed, on a device in software whose streams do nothing before
// they are waited for.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <future>
#include <list>
#include <thread>
#include <vector>

#include "cuda_runtime.h"
#include "meniscus/meniscus.hpp"
#include "pipeline/backend.hpp"
#include "support/particles.hpp"
#include "support/same_bytes.hpp"

namespace meniscus {
namespace {

void expect_equal(const Mesh& mesh, const Mesh& expected) {
    EXPECT_EQ(mesh_sha256(mesh), mesh_sha256(expected));
    EXPECT_TRUE(test::same_bytes(mesh.vertices, expected.vertices));
    EXPECT_TRUE(test::same_bytes(mesh.normals, expected.normals));
    EXPECT_TRUE(test::same_bytes(mesh.triangles, expected.triangles));
    EXPECT_TRUE(test::same_bytes(mesh.bricks, expected.bricks));
}

/// Particles, the CPU's mesh of them, and the mesh that comes down.
struct Frame {
    explicit Frame(test::Particles made, const Settings& settings = test::default_settings())
        : particles(std::move(made)), expected(test::reconstruct(settings, particles.frame())) {
        mesh.cell_size = expected.cell_size;
        mesh.offset_bits = expected.offset_bits;
    }
    explicit Frame(unsigned seed, int side = 6) : Frame(test::splash(seed, side)) {}

    test::Particles particles;
    Mesh expected;
    Mesh mesh;
    MeshDownload download;  // ends before the mesh
};

class CudaDownload : public testing::Test {
protected:
    ~CudaDownload() override { emulated_device::before_copy_to_host = nullptr; }

    void make_device(std::size_t limit = 0, const Settings& settings = test::default_settings()) {
        device_account = std::make_shared<MemoryAccount>(limit, "on the GPU");
        device = cuda::make_reconstruction(settings, BackendOptions{}, account, device_account);
    }
    /// Like a reconstructor after a failure.
    void make_device_again() {
        device.reset();
        device = cuda::make_reconstruction(test::default_settings(), BackendOptions{}, account, device_account);
    }
    void begin(Frame& frame) {
        Statistics statistics;
        frame.download = device->reconstruct(frame.particles.frame(), frame.mesh, statistics);
    }
    static void finish(Frame& frame) {
        frame.download.finish();
        expect_equal(frame.mesh, frame.expected);
    }

    const std::shared_ptr<MemoryAccount> account = std::make_shared<MemoryAccount>();
    std::shared_ptr<MemoryAccount> device_account;
    std::unique_ptr<BackendReconstruction> device;
};

TEST_F(CudaDownload, AMeshComesDownWhileTheNextFramesAreReconstructedGrownCapturedAndReplayed) {
    make_device();
    std::array<Frame, 2> frames{Frame(1), Frame(2)};
    begin(frames[0]);
    for (int i = 0; i < 8; ++i) {
        Frame& last = frames[static_cast<std::size_t>(i % 2)];
        Frame& next = frames[static_cast<std::size_t>((i + 1) % 2)];
        begin(next);
        finish(last);
        if (i == 3) {
            next.download.finish();
            next = Frame(3, 10);
            begin(next);
        }
    }
    const std::uint64_t allocations = device_account->allocations();
    begin(frames[1]);
    begin(frames[0]);
    finish(frames[1]);
    finish(frames[0]);
    EXPECT_EQ(device_account->allocations(), allocations);
}

TEST_F(CudaDownload, TheLaterOfTwoMeshesMayComeDownFirst) {
    make_device();
    Frame first(1), second(2, 8);
    begin(first);
    begin(second);
    finish(second);
    finish(first);
}

TEST_F(CudaDownload, AFrameThatFindsBothSetsOfArraysInUseBringsTheEarlierMeshDown) {
    make_device();
    std::list<Frame> frames;
    for (unsigned seed = 0; seed < 6; ++seed) begin(frames.emplace_back(seed, seed == 4 ? 9 : 6));
    for (Frame& frame : frames) finish(frame);
}

TEST_F(CudaDownload, TrianglesComeDownBrickByBrickAfterTheVertices) {
    Settings settings = test::default_settings();
    settings.mode = Mode::uniform;  // with triangles enough for several runs of them
    settings.field = Field::color;
    settings.cell_size = 0.25;
    make_device(0, settings);
    Frame frame(test::splash(4, 10), settings);
    begin(frame);
    frame.download.start();
    EXPECT_TRUE(test::same_bytes(frame.mesh.vertices, frame.expected.vertices));
    EXPECT_TRUE(test::same_bytes(frame.mesh.normals, frame.expected.normals));
    EXPECT_TRUE(test::same_bytes(frame.mesh.bricks, frame.expected.bricks));
    std::fill(frame.mesh.triangles.begin(), frame.mesh.triangles.end(), Triangle{});
    const auto is_there = [&](const MeshBrick& brick) {
        return std::all_of(brick.ranges.begin(), brick.ranges.end(), [&](const TriangleRange& range) {
            const auto at = static_cast<std::ptrdiff_t>(range.first);
            return std::equal(frame.mesh.triangles.begin() + at, frame.mesh.triangles.begin() + at + range.count,
                              frame.expected.triangles.begin() + at);
        });
    };
    ASSERT_GT(frame.mesh.bricks.size(), 1U);
    for (std::size_t brick = 0; brick < frame.mesh.bricks.size(); ++brick) {
        frame.download.bring(brick);
        EXPECT_TRUE(is_there(frame.mesh.bricks[brick])) << brick;
        if (brick == 0) EXPECT_FALSE(is_there(frame.mesh.bricks.back())) << "not before it is asked for";
    }
    finish(frame);
    EXPECT_GT(frame.download.seconds(), 0.0);
}

TEST_F(CudaDownload, CappedLevelsAreEmittedWhileMeshesAreOnTheirWay) {
    make_device();
    Frame first(1), second(2);
    Reconstructor cpu(test::default_settings(), {Backend::cpu, 1, 0});
    Mesh whole, expected, capped;
    for (int round = 0; round < 3; ++round) {
        begin(first);
        begin(second);
        cpu.reconstruct(second.particles.frame(), whole);
        for (const int max_level : {1, 2}) {
            cpu.emit_capped(max_level, expected);
            capped.cell_size = expected.cell_size;
            capped.offset_bits = expected.offset_bits;
            device->emit_capped(max_level, capped);
            expect_equal(capped, expected);
        }
        finish(second);
        finish(first);
    }
}

TEST_F(CudaDownload, AMeshLeftOnTheDeviceIsInArraysThatNoDownloadReads) {
    make_device();
    Frame frame(1);
    const test::Particles other = test::splash(2, 6);
    begin(frame);
    Statistics statistics;
    const DeviceMesh mesh = device->reconstruct_on_device(other.frame(), statistics);
    const Mesh expected = test::reconstruct(test::default_settings(), other.frame());
    ASSERT_EQ(mesh.triangle_count, expected.triangles.size());
    EXPECT_EQ(std::memcmp(mesh.triangles, expected.triangles.data(), expected.triangles.size() * sizeof(Triangle)), 0);
    finish(frame);
}

TEST_F(CudaDownload, AMeshThatNobodyWantsCostsNoMemoryAndHoldsUpNoFrame) {
    make_device();
    Frame wanted(1);
    for (int i = 0; i < 4; ++i) {
        Frame unwanted(2);
        begin(unwanted);
        if (i % 2 == 0) unwanted.download.start();
    }
    const std::size_t bytes = device_account->bytes();
    for (int i = 0; i < 4; ++i) {
        Frame unwanted(2);
        begin(unwanted);
    }
    EXPECT_EQ(device_account->bytes(), bytes);
    begin(wanted);
    finish(wanted);
}

TEST_F(CudaDownload, MeshesThatComeDownAtOnceNeedOneSetOfArrays) {
    make_device();
    Frame frame(1);
    for (int i = 0; i < 3; ++i) {
        begin(frame);
        finish(frame);
    }
    const std::size_t one = device_account->bytes();
    begin(frame);
    Frame next(1);
    begin(next);
    EXPECT_GT(device_account->bytes(), one);
    finish(frame);
    finish(next);
}

TEST_F(CudaDownload, WhereTheLimitLeavesNoSecondSetAFrameBringsTheMeshBeforeItDown) {
    make_device();
    Frame small(1), large(2, 10);
    for (Frame* frame : {&small, &large}) {
        begin(*frame);
        finish(*frame);
    }
    const std::size_t limit = device_account->peak_bytes();
    make_device(limit);
    for (int i = 0; i < 3; ++i) {
        Frame first(1), second(2, 10), third(3);
        begin(first);
        begin(second);
        EXPECT_GT(first.download.seconds(), 0.0);
        begin(third);
        finish(first);
        finish(second);
        finish(third);
    }
}

TEST_F(CudaDownload, ASecondSetThatWasRefusedIsTriedAgainOnceAFrameNeedsMore) {
    constexpr std::size_t limit = std::size_t{1} << 30;
    make_device(limit);
    Frame first(1), second(1), third(1), large(2, 10);
    begin(first);
    const std::size_t one_set = device_account->bytes();
    const std::size_t others = limit - one_set;
    device_account->charge(others);
    begin(second);
    EXPECT_GT(first.download.seconds(), 0.0);
    device_account->release(others);
    begin(third);
    EXPECT_GT(second.download.seconds(), 0.0);
    EXPECT_EQ(device_account->bytes(), one_set);
    begin(large);
    EXPECT_EQ(third.download.seconds(), 0.0);
    for (Frame* frame : {&first, &second, &third, &large}) finish(*frame);
}

TEST_F(CudaDownload, AfterARefusedFrameThereIsRoomForTheNextHoweverLongDownloadsAreHeld) {
    Frame complete(1), pending(2), next(3);
    const test::Particles too_many = test::splash(4, 40);
    make_device();
    for (Frame* frame : {&complete, &pending, &next}) {
        begin(*frame);
        finish(*frame);
    }
    const std::size_t one_set = device_account->peak_bytes();
    begin(complete);
    begin(pending);
    const std::size_t two_sets = device_account->peak_bytes();
    ASSERT_GT(two_sets, one_set);
    for (const std::size_t limit : {one_set, two_sets}) {
        for (Frame* frame : {&complete, &pending, &next}) frame->download = {};
        make_device(limit);
        begin(complete);
        begin(pending);
        complete.download.finish();
        Statistics statistics;
        Mesh none;
        EXPECT_THROW(static_cast<void>(device->reconstruct(too_many.frame(), none, statistics)), LimitExceeded);
        EXPECT_EQ(pending.download.seconds(), 0.0) << "still to be downloaded";
        make_device_again();
        EXPECT_EQ(device_account->bytes(), 0U);
        begin(next);
        finish(next);
        finish(complete);
        finish(pending);
    }
}

TEST_F(CudaDownload, AMeshComesDownAfterItsReconstructorHasEnded) {
    make_device();
    Frame first(1), second(2);
    begin(first);
    begin(second);
    device.reset();
    finish(first);
    first.download = {};
    finish(second);
    second.download = {};
    EXPECT_EQ(device_account->bytes(), 0U);
}

TEST_F(CudaDownload, ADeviceThatFailsMeanwhileIsReportedToTheCallerAndTheNextFrameWorks) {
    make_device();
    Frame first(1), second(2);
    begin(first);
    first.download.start();
    emulated_device::before_copy_to_host = [] { return cudaErrorLaunchFailure; };
    EXPECT_THROW(first.download.finish(), DeviceError);
    emulated_device::before_copy_to_host = nullptr;
    EXPECT_THROW(first.download.bring(0), DeviceError) << "the mesh is not complete";
    begin(second);
    finish(second);
    EXPECT_THROW(first.download.finish(), DeviceError);
}

TEST_F(CudaDownload, ADeviceWithoutMemoryForACopyHasFailed) {
    make_device();
    Frame frame(1);
    begin(frame);
    emulated_device::before_copy_to_host = [] { return cudaErrorMemoryAllocation; };
    EXPECT_THROW(frame.download.start(), DeviceError);
    emulated_device::before_copy_to_host = nullptr;
    EXPECT_THROW(frame.download.finish(), DeviceError);
}

TEST_F(CudaDownload, ABrickThatIsThereIsTakenWhileOthersComeDown) {
    Settings settings = test::default_settings();
    settings.mode = Mode::uniform;  // with triangles enough for several runs of them
    settings.field = Field::color;
    settings.cell_size = 0.25;
    make_device(0, settings);
    Frame frame(test::splash(4, 10), settings);
    begin(frame);
    frame.download.bring(0);
    bool taken = false;
    std::future<void> taker;
    emulated_device::before_copy_to_host = [&] {
        if (!taker.valid()) {
            taker = std::async(std::launch::async, [&] { frame.download.bring(0); });
            taken = taker.wait_for(std::chrono::seconds(20)) == std::future_status::ready;
        }
        return cudaSuccess;
    };
    finish(frame);
    EXPECT_TRUE(taken);
}

TEST_F(CudaDownload, OneThreadTakesTheMeshesThatAnotherMakes) {
    make_device();
    std::array<Frame, 3> frames{Frame(1), Frame(2), Frame(3, 9)};
    for (int round = 0; round < 4; ++round) {
        std::thread taker;
        for (Frame& frame : frames) {
            begin(frame);
            if (taker.joinable()) taker.join();
            taker = std::thread([&frame] {
                frame.download.start();
                for (std::size_t brick = 0; brick < frame.mesh.bricks.size(); ++brick) frame.download.bring(brick);
            });
        }
        taker.join();
        for (Frame& frame : frames) finish(frame);
    }
}

}  // namespace
}  // namespace meniscus
