// White noise over random levels through the pipeline with CUDA's steps, on the device in software: closed, and the
// CPU's mesh and packed bricks to the bit.
#include <gtest/gtest.h>

#include <cstring>

#include "engine/cuda/array_memory.hpp"
#include "meniscus/brick_coding.hpp"
#include "pipeline/cuda_packed_bricks.hpp"
#include "pipeline/cuda_pipeline.hpp"
#include "pipeline/pipeline.hpp"
#include "pipeline/stage_clock.hpp"
#include "steps/fill_cracks/volume.hpp"
#include "support/mesh_check.hpp"
#include "support/noise.hpp"
// The steps are templates over the field.
#include "steps/place_vertices/place_vertices.cu"
#include "steps/sample_field/sample_field.cu"

namespace meniscus {
namespace {

/// A field in the place of cuda::ParticleField.
struct NoiseField {
    struct Shared {};
    static constexpr bool has_own_supports = false;

    test::NoiseWorld world;

    struct Near {
        const test::NoiseWorld& world;
        Int3 base_cell;

        float value(const UnitBox&, float x, float y, float z) const {
            return test::noise_value(world, base_cell, x, y, z);
        }
        void column(const UnitBox& box, float x, float y, float z, float upper_z, bool are_two,
                    float (&values)[2]) const {
            values[0] = value(box, x, y, z);
            if (are_two) values[1] = value(box, x, y, upper_z);
        }
        Normal normal(const UnitBox&, float, float, float) const {
            const float none = std::nanf("");
            return {none, none, none};
        }
    };
    Near near(const cuda::State& state, const cuda::Cluster& cluster, const UnitBox&, Shared&) const {
        return {world, cluster.coordinate(state.blocks())};
    }
};
/// Such a field has no attributes.
void place_attributes(const cuda::State&, const NoiseField&, const cuda::Launcher&) {}

/// The device's memory is the host's: the steps that need particles are done by the host between waits for the stream.
template <Slivers slivers>
class NoiseSteps : public cuda::SurfaceSteps<NoiseField, slivers> {
    using Surface = cuda::SurfaceSteps<NoiseField, slivers>;
    using Surface::field_;
    using Surface::launch_;
    using Surface::state_;

public:
    NoiseSteps(cuda::State& state, const test::NoiseWorld& world, const cuda::Launcher& launch)
        : Surface(state, NoiseField{world}, launch), levels_(test::noise_levels(world)) {}

    void register_particles() {
        wait();
        std::memset(state_.counts, 0, sizeof(cuda::Counts));
        std::uint32_t bricks = 0;
        for (int i = 0; i < 8; ++i) {
            Brick& brick = state_.bricks[bricks];
            brick.coordinate = {i & 1, i >> 1 & 1, i >> 2};
            brick.clear();
            if (!test::mark_world(field_.world, brick.coordinate, brick.occupied)) continue;
            state_.brick_keys[bricks] = brick_key(brick.coordinate);
            state_.members_before[bricks++] = brick.count();
        }
        state_.counts->needed[static_cast<int>(cuda::Resource::bricks)] = bricks;
        cuda::store_blocks(state_, launch_);
    }
    void sample_base_vertices() {
        wait();
        const BlocksView blocks = state_.blocks();
        for (std::uint32_t b = 0; b < blocks.count; ++b) {
            const float value = test::noise_value(field_.world, blocks.coordinate(b), 0.0F, 0.0F, 0.0F);
            state_.samples[b] = value;
            state_.first_sample[b] = b;
            state_.sampled[b] = 1;
            state_.inside[b] = value > state_.settings.iso ? 1 : 0;
        }
        state_.counts->needed[static_cast<int>(cuda::Resource::samples)] = blocks.count;
    }
    /// As with particles, a cell may start outside the band only if its corners agree.
    void split_cells() {
        const BlocksView blocks = state_.blocks();
        for (std::uint32_t b = 0; b < blocks.count; ++b) {
            const ClosedCell cell(blocks, b);
            int inside = 0;
            for (const std::uint32_t corner : cell.block) inside += static_cast<int>(blocks.inside_or_none(corner) & 1);
            const bool agree = inside == 0 || inside == 8;
            state_.wanted_level[b] = levels_.wanted[b];
            state_.bends[b] = levels_.bends[b];
            state_.level[b] = !agree || levels_.starts[b] ? levels_.wanted[b] : std::uint8_t{0};
        }
        cuda::collect_level_sets(state_, launch_);
    }

private:
    void wait() { cuda::check(cudaStreamSynchronize(launch_.stream), "cudaStreamSynchronize"); }

    test::NoiseLevels levels_;
};

class NoiseOnDevice {
public:
    explicit NoiseOnDevice(const test::NoiseWorld& world)
        : storage_(std::make_shared<cuda::MeshStorage>(0, std::make_shared<MemoryAccount>(),
                                                       std::make_shared<MemoryAccount>())),
          memory_(0, stream_.get(), std::make_shared<MemoryAccount>()),
          mesh_memory_(0, stream_.get(), std::make_shared<MemoryAccount>()),
          state_(LatticeSettings(test::noise_settings(world))) {
        constexpr std::uint64_t room = 65536;
        state_.capacity.particles = 1;
        state_.capacity.of.fill(room);
        state_.capacity.of[static_cast<std::size_t>(cuda::Resource::bricks)] = 8;
        state_.keeps_lattice = true;
        state_.capacity.of[static_cast<std::size_t>(cuda::Resource::blocks)] = 4096;
        state_.scratch_bytes = cuda::scratch_bytes(room, room, room);
        memory_.assign(state_.arrays());
        mesh_memory_.assign(state_.mesh_arrays());
        state_.upload_tables(stream_.get());
    }

    Mesh mesh(const test::NoiseWorld& world) {
        const cuda::Launcher launch{stream_.get(), 1};
        const auto run = [&](auto steps) {
            NoClock clock;
            run_pipeline(steps, clock);
            if (world.max_level < 3) {
                cuda::cap_levels(state_, world.max_level, true, launch);
                emit_mesh(steps, clock);
            }
            cuda::keep_lattice(state_, launch);
        };
        if (world.keeps_slivers)
            run(NoiseSteps<Slivers::kept>(state_, world, launch));
        else
            run(NoiseSteps<Slivers::raised>(state_, world, launch));
        stream_.synchronize();
        EXPECT_EQ(state_.counts->stop, cuda::Stop::none);
        sixfold_volume_ = state_.counts->sixfold_volume;
        const auto needed = [&](cuda::Resource r) { return state_.counts->needed[static_cast<int>(r)]; };
        Mesh mesh;
        mesh.cell_size = state_.settings.cell_size;
        mesh.offset_bits = state_.settings.offset_bits;
        mesh.vertices.assign(state_.vertices, state_.vertices + needed(cuda::Resource::vertices));
        mesh.triangles.assign(state_.triangles, state_.triangles + needed(cuda::Resource::triangles));
        for (std::size_t level = 0; level < triangle_level_count; ++level)
            mesh.levels[level] = {state_.counts->first_triangle[level],
                                  static_cast<std::uint32_t>(state_.counts->triangles[level])};
        std::vector<cuda::BrickOnDevice> bricks;
        for (std::uint32_t b = 0; b < needed(cuda::Resource::bricks); ++b) {
            if (state_.mesh_bricks[b].triangle_count() == 0) continue;
            mesh.bricks.push_back(state_.mesh_bricks[b]);
            bricks.push_back({.index = b, .kept = state_.kept_bricks[b]});
        }
        pack(mesh, bricks);
        return mesh;
    }

    /// The bricks of the mesh made last.
    std::vector<EncodedBrick> packed;

    /// Six times the volume of the mesh before its levels were capped.
    std::uint64_t measured_sixfold_volume() const { return sixfold_volume_; }

private:
    void pack(const Mesh& mesh, const std::vector<cuda::BrickOnDevice>& bricks) {
        cuda::MeshOnDevice from;
        from.mesh.normals = state_.normals;
        from.lattice = {.vertices = state_.vertices,
                        .normals = state_.normals,
                        .blocks = state_.lattice_blocks,
                        .kept = state_.kept_blocks,
                        .bricks = state_.kept_bricks,
                        .offset_bits = state_.settings.offset_bits};
        cuda::DevicePackedBricks of_mesh(storage_, from, mesh, bricks, {}, std::make_shared<cuda::CopyTime>());
        packed.clear();
        for (std::size_t i = 0; i < bricks.size(); ++i) packed.push_back(of_mesh.bring(i));
    }

    std::shared_ptr<cuda::MeshStorage> storage_;
    cuda::Stream stream_;
    cuda::ArrayMemory memory_, mesh_memory_;
    cuda::State state_;
    std::uint64_t sixfold_volume_ = 0;
};

void expect_closed(const test::NoiseWorld& world, std::uint64_t first, std::uint64_t count) {
    NoiseOnDevice device(world);
    test::for_each_seed(world, first, count, [&](const test::NoiseWorld& seeded) {
        const Mesh mesh = device.mesh(seeded);
        const test::MeshReport report = test::check(mesh);
        ASSERT_TRUE(report.closed_manifold()) << "seed " << seeded.seed << ": " << report.text();
        const Mesh expected = test::mesh_of_noise_on_cpu(seeded);
        ASSERT_EQ(mesh.vertices, expected.vertices) << "seed " << seeded.seed;
        ASSERT_EQ(mesh.triangles, expected.triangles) << "seed " << seeded.seed;
        ASSERT_FALSE(mesh.triangles.empty()) << "seed " << seeded.seed;
        std::uint64_t sixfold = 0;
        for (const Triangle& triangle : mesh.triangles)
            sixfold += static_cast<std::uint64_t>(sixfold_volume(mesh.vertices.data(), triangle));
        ASSERT_EQ(device.packed.size(), expected.bricks.size()) << "seed " << seeded.seed;
        for (std::size_t i = 0; i < expected.bricks.size(); ++i)
            ASSERT_EQ(device.packed[i].data, encode_brick(expected, i, {.codec = Codec::lattice_packed}).data)
                << "seed " << seeded.seed << ", brick " << i;
        if (seeded.max_level == 3) ASSERT_EQ(device.measured_sixfold_volume(), sixfold) << "seed " << seeded.seed;
    });
}

TEST(WhiteNoiseEmulated, GivesClosedManifoldsOverRandomLevels) {
    expect_closed({}, 1, 60);
}
TEST(WhiteNoiseEmulated, GivesClosedManifoldsWhereSliversAreRaised) {
    expect_closed({.keeps_slivers = false}, 7001, 25);
}
TEST(WhiteNoiseEmulated, GivesTheCpusMeshAcrossEightBricks) {
    for (const int max_level : {3, 2}) expect_closed({.first = 14, .max_level = max_level}, 10'001, 20);
    expect_closed({.first = 14, .uniform = true}, 11'001, 5);
}
TEST(WhiteNoiseEmulated, GivesClosedManifoldsWhereFewPointsAreInsideOrOutside) {
    expect_closed({.share = 0.15}, 1001, 20);
    expect_closed({.share = 0.85}, 2001, 20);
}
TEST(WhiteNoiseEmulated, GivesClosedManifoldsWhereValuesLieOnTheIsoValue) {
    expect_closed({.ties = true}, 3001, 20);
}
TEST(WhiteNoiseEmulated, GivesClosedManifoldsWhenTheBandMustGrow) {
    expect_closed({.share = 0.02, .band_share = 0.1}, 4001, 20);
}
TEST(WhiteNoiseEmulated, GivesTheCpusMeshWhereTheBandGrowsBesideSlivers) {
    expect_closed({.share = 0.04, .keeps_slivers = false, .band_share = 0.6}, 9001, 30);
    expect_closed({.share = 0.985, .keeps_slivers = false, .band_share = 0.2}, 9081, 30);
}
TEST(WhiteNoiseEmulated, GivesClosedManifoldsWhereLevelsAreCapped) {
    for (const int max_level : {1, 2}) expect_closed({.max_level = max_level}, 8001, 20);
}
TEST(WhiteNoiseEmulated, GivesClosedManifoldsInUniformModeAndWithBisection) {
    expect_closed({.side = 3, .uniform = true}, 5001, 10);
    expect_closed({.bisects = true, .keeps_slivers = false}, 6001, 10);
}

}  // namespace
}  // namespace meniscus
