// Graphs and the times of stages are a matter of speed and of knowledge: a frame without them has the same mesh.
#include <gtest/gtest.h>

#include <memory>

#include "engine/cuda/fault_finding.hpp"
#include "events_and_graphs.hpp"
#include "meniscus/meniscus.hpp"
#include "pipeline/backend.hpp"
#include "support/environment.hpp"
#include "support/particles.hpp"
#include "support/same_bytes.hpp"

namespace meniscus {
namespace {

constexpr const char* variable = "MENISCUS_NO_GRAPH";

/// Reconstructs some frames; returns how many graphs were launched.
std::size_t launches_of_frames(int frames) {
    const test::Particles particles = test::splash(3, 5);
    const Settings settings = test::default_settings();
    const Mesh expected = test::reconstruct(settings, particles.frame());
    const std::size_t before = emulated_device::graph_launches;
    const auto backend = cuda::make_reconstruction(settings, BackendOptions{}, std::make_shared<MemoryAccount>(),
                                                   std::make_shared<MemoryAccount>());
    for (int i = 0; i < frames; ++i) {
        Mesh mesh;
        Statistics statistics;
        backend->reconstruct(particles.frame(), mesh, statistics).finish();
        EXPECT_TRUE(test::same_bytes(mesh.vertices, expected.vertices));
        EXPECT_TRUE(test::same_bytes(mesh.triangles, expected.triangles));
        for (const double seconds : statistics.stage_seconds) EXPECT_EQ(seconds, 0.0);
    }
    return emulated_device::graph_launches - before;
}

TEST(GraphsEmulated, FramesThatNeedNoMoreRoomAreReplayedUnlessTheEnvironmentForbidsIt) {
    for (const char* const value : {"", "0"}) {
        const test::EnvironmentVariable chosen(variable, value);
        EXPECT_EQ(launches_of_frames(5), 3U);
    }
    const test::EnvironmentVariable chosen(variable, "1");
    EXPECT_EQ(launches_of_frames(5), 0U);
}

TEST(GraphsEmulated, AChoiceThatIsNoneIsRefused) {
    const test::EnvironmentVariable chosen(variable, "yes");
    EXPECT_THROW(cuda::uses_graphs(), InvalidInput);
}

TEST(GraphsEmulated, TimesThatCannotBeToldFailNoFrame) {
    emulated_device::elapsed_time_status = cudaErrorInvalidValue;
    EXPECT_GT(launches_of_frames(4), 0U);
    emulated_device::elapsed_time_status = cudaSuccess;
}

}  // namespace
}  // namespace meniscus
