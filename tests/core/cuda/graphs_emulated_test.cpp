// Graphs and the times of stages are a matter of speed and of knowledge: a frame without them has the same mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/cuda/fault_finding.hpp"
#include "engine/cuda/launch_observer.hpp"
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
std::size_t launches_of_frames(int frames, const BackendOptions& options = {}) {
    const test::Particles particles = test::splash(3, 5);
    const Settings settings = test::default_settings();
    const Mesh expected = test::reconstruct(settings, particles.frame());
    const std::size_t before = emulated_device::graph_launches;
    const auto backend = cuda::make_reconstruction(settings, options, std::make_shared<MemoryAccount>(),
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

TEST(GraphsEmulated, WhereCudaMakesNoGraphFramesRunWithoutAndTheCallerIsToldOnce) {
    std::vector<std::string> notices;
    BackendOptions options;
    options.notice = [&](const std::string& what) { notices.push_back(what); };
    emulated_device::instantiate_status = cudaErrorInvalidValue;
    EXPECT_EQ(launches_of_frames(6, options), 0U);
    EXPECT_EQ(launches_of_frames(3), 0U) << "also where nobody is told";
    emulated_device::instantiate_status = cudaSuccess;
    ASSERT_EQ(notices.size(), 1U);
    EXPECT_NE(notices[0].find("cudaGraphInstantiate"), std::string::npos) << notices[0];
}

/// Sees the blocks of cooperative grids.
struct CooperativeGrids final : cuda::LaunchObserver {
    CooperativeGrids() { cuda::launch_observer = this; }
    ~CooperativeGrids() { cuda::launch_observer = nullptr; }
    void before(const cuda::Launch& launch) override {
        if (launch.is_cooperative) most_blocks = std::max(most_blocks, launch.blocks);
    }
    void after(const cuda::Launch&) noexcept override {}
    unsigned most_blocks = 0;
};

TEST(GraphsEmulated, CooperativeGridsHaveNoMoreBlocksThanTheEnvironmentAllows) {
    const std::vector<std::pair<const char*, unsigned>> choices{
        {"", emulated_device::blocks_of_processor}, {"1", 1U}, {"2", 2U}};
    for (const auto& [value, most] : choices) {
        const test::EnvironmentVariable chosen("MENISCUS_COOPERATIVE_BLOCKS", value);
        CooperativeGrids grids;
        launches_of_frames(1);
        EXPECT_EQ(grids.most_blocks, most);
    }
    for (const char* const value : {"0", "-1", "two", "3 "}) {
        const test::EnvironmentVariable chosen("MENISCUS_COOPERATIVE_BLOCKS", value);
        EXPECT_THROW(static_cast<void>(cuda::most_cooperative_blocks()), InvalidInput) << value;
    }
}

TEST(GraphsEmulated, KernelsWhoseBlocksFillSharedMemoryAskForAsMuchAsThereIs) {
    emulated_device::most_shared.clear();
    launches_of_frames(1);
    EXPECT_EQ(emulated_device::most_shared.size(), 3U) << "those that sample, settle the band and place vertices";
}

TEST(GraphsEmulated, TimesThatCannotBeToldFailNoFrame) {
    emulated_device::elapsed_time_status = cudaErrorInvalidValue;
    EXPECT_GT(launches_of_frames(4), 0U);
    emulated_device::elapsed_time_status = cudaSuccess;
}

}  // namespace
}  // namespace meniscus
