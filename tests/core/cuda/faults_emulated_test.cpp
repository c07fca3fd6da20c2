// Faults, put into the software device's copies of the CUDA backend, and for each the check that catches it.
// Without that check the faulty backend would pass for a right one, and its test here would fail.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <utility>

#include "cuda_runtime.h"
#include "faults.hpp"
#include "meniscus/meniscus.hpp"
#include "pipeline/backend.hpp"
#include "support/environment.hpp"
#include "support/particles.hpp"
#include "support/same_bytes.hpp"

namespace meniscus {
namespace {

using emulated_device::Fault;
using emulated_device::FaultInForce;

/// The CPU and the software device, for the same frame again and again.
class Comparison {
public:
    explicit Comparison(const char* placement, const Settings& settings = test::default_settings(),
                        test::Particles particles = test::splash(3, 7))
        : particles_(std::move(particles)), settings_(settings), placement_("MENISCUS_DEVICE_ARRAYS", placement) {
        expected_ = test::reconstruct(settings_, particles_.frame());
        device_ = cuda::make_reconstruction(settings_, {.keep_lattice = true}, std::make_shared<MemoryAccount>(),
                                            std::make_shared<MemoryAccount>());
    }

    const Mesh& expected() const { return expected_; }
    const Mesh& reconstruct() {
        Statistics statistics;
        device_->reconstruct(particles_.frame(), mesh_, statistics).finish();
        return mesh_;
    }
    bool gives_the_cpus_bytes() {
        const Mesh& mesh = reconstruct();
        return test::same_bytes(mesh.vertices, expected_.vertices) &&
               test::same_bytes(mesh.normals, expected_.normals) &&
               test::same_bytes(mesh.triangles, expected_.triangles) && test::same_bytes(mesh.spray, expected_.spray);
    }
    /// Reconstructs in a few orders of threads and blocks.
    bool gives_the_cpus_bytes_in_any_order() {
        for (unsigned seed = 1; seed <= 4; ++seed) {
            emulated_device::seed_order(seed);
            if (!gives_the_cpus_bytes()) return false;
        }
        return true;
    }
    /// The same for the bricks that it packs.
    bool packs_the_cpus_bytes_in_any_order() {
        CodingOptions options;
        options.codec = Codec::lattice_packed;
        mesh_.cell_size = expected_.cell_size;
        mesh_.offset_bits = expected_.offset_bits;
        for (unsigned seed = 1; seed <= 4; ++seed) {
            emulated_device::seed_order(seed);
            Statistics statistics;
            const MeshDownload download = device_->reconstruct(particles_.frame(), mesh_, statistics);
            const auto bricks = download.pack(mesh_, options);
            for (std::size_t i = 0; i < expected_.bricks.size(); ++i)
                if (bricks->bring(i).data != encode_brick(expected_, i, options).data) return false;
        }
        return true;
    }
    /// The text of the device's error; empty if there is none.
    std::string error() {
        try {
            reconstruct();
        } catch (const DeviceError& error) {
            return error.what();
        }
        return {};
    }

private:
    test::Particles particles_;
    Settings settings_;
    test::EnvironmentVariable placement_;
    Mesh expected_;
    Mesh mesh_;
    std::unique_ptr<BackendReconstruction> device_;
};

#define EXPECT_CONTAINS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(FaultsEmulated, AnIndexOffByOneIsCaughtByTheComparisonWithTheCpu) {
    Comparison comparison("together");
    ASSERT_TRUE(comparison.gives_the_cpus_bytes());
    const FaultInForce fault(Fault::index_off_by_one);
    EXPECT_FALSE(comparison.gives_the_cpus_bytes());
}

TEST(FaultsEmulated, AMissingBarrierIsCaughtByTheOrderOfChanceOfWarps) {
    Comparison comparison("together");
    ASSERT_TRUE(comparison.packs_the_cpus_bytes_in_any_order());
    const FaultInForce fault(Fault::missing_barrier);
    EXPECT_FALSE(comparison.packs_the_cpus_bytes_in_any_order());
}

TEST(FaultsEmulated, AStopThatLateBlocksReadIsCaughtByTheOrderOfChanceOfBlocks) {
    // More bricks of particles than there is room for at first, and particles of two blocks.
    test::Particles apart;
    for (int y = 0; y < 15; ++y)
        for (int x = 0; x < 20; ++x) apart.add(7.5F * static_cast<float>(x), 7.5F * static_cast<float>(y), 0.0F);
    Settings settings = test::default_settings();
    settings.field = Field::color;
    settings.mode = Mode::uniform;
    settings.cell_size = 4.0;
    const auto first_frame_is_the_cpus = [&](unsigned seed) {
        emulated_device::seed_order(seed);
        Comparison comparison("guarded", settings, apart);
        return comparison.error().empty() && comparison.gives_the_cpus_bytes();
    };
    EXPECT_TRUE(first_frame_is_the_cpus(1));
    const FaultInForce fault(Fault::early_stop);
    EXPECT_DEATH(
        {
            for (unsigned seed = 1; seed <= 3; ++seed)
                if (!first_frame_is_the_cpus(seed)) std::abort();
        },
        "");
}

TEST(FaultsEmulated, AWrongMaskIsCaughtByTheCheckOfMasks) {
    Comparison comparison("together");
    const FaultInForce fault(Fault::wrong_mask);
    EXPECT_DEATH(comparison.reconstruct(), "a lane is not in its own mask: __ballot_sync");
}

TEST(FaultsEmulated, AnUnsetWordIsCaughtByThePoisonBetweenFrames) {
    for (const char* const placement : {"together", "guarded"}) {
        SCOPED_TRACE(placement);
        Comparison comparison(placement);
        ASSERT_TRUE(comparison.gives_the_cpus_bytes());
        const FaultInForce fault(Fault::unset_word);
        EXPECT_EQ(comparison.gives_the_cpus_bytes(), std::string(placement) == "together")
            << "what the same frame before has left is right";
    }
}

TEST(FaultsEmulated, AnOverrunIsCaughtByTheGuardsAroundArrays) {
    const FaultInForce fault(Fault::guard_overrun);
    EXPECT_TRUE(Comparison("together").gives_the_cpus_bytes()) << "where it lands there is nothing";
    EXPECT_CONTAINS(Comparison("guarded").error(), "was overrun 0 bytes after its end");
}

TEST(FaultsEmulated, AMissingWaitIsCaughtByWorkThatStaysInItsStreamUntilTheHostWaits) {
    Settings settings = test::default_settings();
    settings.field = Field::smooth;
    settings.spray = Spray::points;
    Comparison comparison("together", settings);
    ASSERT_FALSE(comparison.expected().spray.empty());
    {
        const FaultInForce fault(Fault::missing_wait);
        EXPECT_FALSE(comparison.gives_the_cpus_bytes());
    }
    EXPECT_TRUE(comparison.gives_the_cpus_bytes());
}

TEST(FaultsEmulated, AWrongCountOfBlocksIsCaughtByTheCheckOfCooperativeGrids) {
    Comparison comparison("together");
    const FaultInForce fault(Fault::wrong_block_count);
    EXPECT_CONTAINS(comparison.error(), "too many blocks in cooperative launch");
}

TEST(FaultsEmulated, ALostFlagIsCaughtByCooperativeGridsOfSeveralBlocks) {
    // Drops in the first bricks, which the first block of threads looks after, need no sweeps.
    test::Particles particles;
    for (int i = 1; i <= 8; ++i) particles.add(0.8F, 0.8F, -5.0F * static_cast<float>(i));
    const test::Particles splash = test::splash(3, 7);
    particles.positions.insert(particles.positions.end(), splash.positions.begin(), splash.positions.end());
    Settings settings = test::default_settings();
    settings.field = Field::color;
    settings.criterion = CountCriterion{};
    Comparison comparison("together", settings, particles);
    ASSERT_TRUE(comparison.gives_the_cpus_bytes());
    const FaultInForce fault(Fault::lost_flag);
    EXPECT_FALSE(comparison.gives_the_cpus_bytes());
}

TEST(FaultsEmulated, AnUnstableOrderIsCaughtByTheComparisonOfBytesWhereThatOfHashesPasses) {
    Comparison comparison("together");
    ASSERT_TRUE(comparison.gives_the_cpus_bytes());
    const FaultInForce fault(Fault::unstable_order);
    EXPECT_FALSE(comparison.gives_the_cpus_bytes_in_any_order());
    Mesh mesh = comparison.reconstruct();
    mesh.cell_size = comparison.expected().cell_size;
    mesh.offset_bits = comparison.expected().offset_bits;
    EXPECT_EQ(mesh_sha256(mesh), mesh_sha256(comparison.expected()));
}

TEST(FaultsEmulated, ScratchMemoryThatIsTooSmallIsCaughtByTheCheckOfWhatCubAsksFor) {
    Comparison comparison("together");
    const FaultInForce fault(Fault::scratch_too_small);
    EXPECT_CONTAINS(comparison.error(), "cub::DeviceScan");
}

}  // namespace
}  // namespace meniscus
