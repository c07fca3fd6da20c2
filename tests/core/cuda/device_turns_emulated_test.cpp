// Reconstructors that share a device, on the device in software: their frames take turns there.
#include <cuda_runtime.h>
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "engine/cuda/device_turn.hpp"
#include "engine/cuda/launch_observer.hpp"
#include "meniscus/meniscus.hpp"
#include "pipeline/backend.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

/// Whether another thread could begin a frame on the device now.
bool is_free(int device) {
    return std::async(std::launch::async,
                      [&] {
                          std::mutex& turn = cuda::turn_on(device);
                          const bool got_it = turn.try_lock();
                          if (got_it) turn.unlock();
                          return got_it;
                      })
        .get();
}

/// A reconstructor's part around a backend on device 0.
class OnTheDevice {
public:
    std::string mesh_of(const test::Particles& particles) {
        const Settings settings = test::default_settings();
        Mesh mesh;
        mesh.cell_size = world_cell_size(settings);
        mesh.offset_bits = offset_bits(settings);
        Statistics statistics;
        backend_->reconstruct(particles.frame(), mesh, statistics).finish();
        return mesh_sha256(mesh);
    }

private:
    std::unique_ptr<BackendReconstruction> backend_ =
        cuda::make_reconstruction(test::default_settings(), BackendOptions{}, std::make_shared<MemoryAccount>(),
                                  std::make_shared<MemoryAccount>());
};

class DeviceTurns : public testing::Test {
protected:
    ~DeviceTurns() override { emulated_device::on_kernel = nullptr; }
};

TEST_F(DeviceTurns, AFrameHasTheDeviceAloneWhileItsKernelsAreLaunchedAndRun) {
    struct FreeAtLaunch final : cuda::LaunchObserver {
        void before(const cuda::Launch&) override { (is_free(0) ? while_free : while_taken)++; }
        void after(const cuda::Launch&) noexcept override {}
        int while_free = 0, while_taken = 0;
    } launches;
    int cooperative = 0;
    emulated_device::on_kernel = [&](bool is_cooperative) {
        cooperative += is_cooperative ? 1 : 0;
        EXPECT_FALSE(is_free(0));
        EXPECT_TRUE(is_free(1)) << "another device";
    };
    OnTheDevice device;
    cuda::launch_observer = &launches;
    // Grown, run launch by launch, captured, replayed.
    for (int frame = 0; frame < 5; ++frame) {
        device.mesh_of(test::splash(3, 4));
        EXPECT_TRUE(is_free(0)) << "after frame " << frame;
    }
    cuda::launch_observer = nullptr;
    EXPECT_EQ(launches.while_free, 0);
    EXPECT_GT(launches.while_taken, 100);
    EXPECT_GE(cooperative, 10);
}

TEST_F(DeviceTurns, AFrameThatFailsEndsItsTurn) {
    OnTheDevice device;
    emulated_device::before_copy_to_host = [] { return cudaErrorLaunchFailure; };
    EXPECT_THROW(device.mesh_of(test::splash(3, 4)), DeviceError);
    emulated_device::before_copy_to_host = nullptr;
    EXPECT_TRUE(is_free(0));
}

TEST_F(DeviceTurns, FramesOfTwoReconstructorsGiveTheirMeshes) {
    const test::Particles particles[] = {test::splash(3, 4), test::splash(4, 5)};
    std::vector<std::thread> threads;
    for (const test::Particles& own : particles)
        threads.emplace_back([&] {
            const std::string expected = mesh_sha256(test::reconstruct(test::default_settings(), own.frame()));
            OnTheDevice device;
            for (int frame = 0; frame < 6; ++frame) EXPECT_EQ(device.mesh_of(own), expected);
        });
    for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace meniscus
