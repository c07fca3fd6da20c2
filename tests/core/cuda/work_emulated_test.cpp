// The limit of a frame's work and the stop of a reconstruction on the device in software: as on the CPU.
#include <cuda_runtime.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "meniscus/meniscus.hpp"
#include "pipeline/backend.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

/// Calls a function whenever a kernel asks the time, as kernels do that look at the stop flag.
struct ClockHook {
    explicit ClockHook(std::function<void()> call) { emulated_device::on_clock = std::move(call); }
    ~ClockHook() { emulated_device::on_clock = nullptr; }
    ClockHook(const ClockHook&) = delete;
    ClockHook& operator=(const ClockHook&) = delete;
};

std::unique_ptr<BackendReconstruction> make_backend(const Settings& settings, const BackendOptions& options) {
    return cuda::make_reconstruction(settings, options, std::make_shared<MemoryAccount>(),
                                     std::make_shared<MemoryAccount>());
}

std::string refusal_of(BackendReconstruction& backend, const test::Particles& particles) {
    Mesh mesh;
    Statistics statistics;
    try {
        backend.reconstruct(particles.frame(), mesh, statistics).finish();
        return {};
    } catch (const LimitExceeded& error) {
        return error.what();
    }
}

TEST(WorkEmulated, IsEstimatedAsOnTheCpu) {
    BackendOptions options{Backend::cpu, 1, 0};
    // Few particles are too much work only under a low limit.
    options.work_limit = 20.0;
    Settings fine = test::default_settings();
    fine.particle_radius = 1.0;
    fine.field = Field::color;
    fine.cell_size = 1.0 / 24.0;
    test::Particles clump;
    for (int i = 0; i < 4000; ++i) clump.add(0.0F, 0.0F, 0.0F);
    Reconstructor cpu(fine, options);
    std::string expected;
    Mesh mesh;
    try {
        cpu.reconstruct(clump.frame(), mesh);
    } catch (const LimitExceeded& error) {
        expected = error.what();
    }
    EXPECT_NE(expected.find("the field at the base cells"), std::string::npos) << expected;
    const auto backend = make_backend(fine, options);
    EXPECT_EQ(refusal_of(*backend, clump), expected);
    const test::Particles good = test::splash(2, 3, 1.0F);
    EXPECT_EQ(refusal_of(*backend, good), "");

    Settings plain = test::default_settings();
    test::Particles crowd;
    for (int i = 0; i < 18'000; ++i) crowd.add(0.0F, 0.0F, 0.0F);
    const std::string sums = refusal_of(*make_backend(plain, options), crowd);
    EXPECT_NE(sums.find("the field at the particles' places"), std::string::npos) << sums;
}

/// Raises the stop flag at `tries` of the places at which kernels ask, evenly over the frame.
void expect_stops(const test::Particles& particles, int tries) {
    const Settings settings = test::default_settings();
    const std::string expected = mesh_sha256(test::reconstruct(settings, particles.frame()));
    const auto flag = std::make_shared<StopFlag>();
    BackendOptions options;
    options.stop = flag;
    const auto backend = make_backend(settings, options);
    Mesh mesh;
    const auto reconstruct = [&] {
        Statistics statistics;
        backend->reconstruct(particles.frame(), mesh, statistics).finish();
        mesh.cell_size = world_cell_size(settings);
        mesh.offset_bits = offset_bits(settings);
    };
    // The first frames find their room, then a graph is replayed.
    int asked = 0;
    for (int i = 0; i < 4; ++i) {
        asked = 0;
        const ClockHook count([&] { ++asked; });
        reconstruct();
    }
    ASSERT_GT(asked, 20);
    for (int i = 0; i < tries; ++i) {
        SCOPED_TRACE(i);
        const int at = 1 + asked * i / tries;  // not the very last one, after which there is nothing to stop
        int asks = 0;
        {
            const ClockHook raise([&] {
                if (++asks == at) flag->raise();
            });
            EXPECT_THROW(reconstruct(), Stopped);
        }
        flag->lower();
        reconstruct();
        EXPECT_EQ(mesh_sha256(mesh), expected);
    }
    flag->raise();
    EXPECT_THROW(reconstruct(), Stopped) << "before any kernel";
}

TEST(StopEmulated, EndsAFrameAtAnyKernelThatAsksAndTheNextIsAsEver) {
    expect_stops(test::splash(4, 5), 10);
}
TEST(StopEmulated, LanesThatShareAParticleStopTogether) {
    expect_stops(test::splash(4, 2), 60);
}

}  // namespace
}  // namespace meniscus
