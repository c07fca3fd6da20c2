// The pipeline's first steps, which ask for particles, are replaced; the others are the reconstruction's own.
#include "support/noise.hpp"

#include <cmath>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <random>

#include "engine/cpu/state.hpp"
#include "neighbors/cpu/clusters.hpp"
#include "pipeline/cpu_pipeline.hpp"
#include "pipeline/pipeline.hpp"
#include "pipeline/stage_clock.hpp"

namespace meniscus::test {
namespace {

class NoiseField final : public cpu::FieldSource {
public:
    explicit NoiseField(const NoiseWorld& world) : world_(world) {}

    void values(const Int3& base_cell, cpu::PointList& points, float* out, unsigned) override {
        for (std::size_t i = 0; i < points.count; ++i)
            out[i] = noise_value(world_, base_cell, points.x[i], points.y[i], points.z[i]);
    }
    void cluster_values(const Int3& lowest_base_cell, const cpu::ClusterPoints& points, cpu::ClusterValues& values,
                        unsigned) override {
        float* room = values.room;
        for (std::size_t i = 0; i < points.size(); ++i, room += 64) {
            if (points[i] != ~BlockMask{0}) values.of[i] = room;
            float* next = values.of[i];
            for (BlockMask left = points[i]; left != 0; left &= left - 1) {
                const int bit = lowest_bit(left);
                const auto coordinate = [bit](int axis) {
                    return static_cast<float>(point_coordinate(bit, axis) * units_per_cell);
                };
                *next++ = noise_value(world_, lowest_base_cell + cpu::cluster_step(static_cast<int>(i)), coordinate(0),
                                      coordinate(1), coordinate(2));
            }
        }
    }
    void normals(const Int3&, cpu::PointList& points, const cpu::NormalRows& normals, unsigned) override {
        for (std::size_t i = 0; i < points.count; ++i) normals.x[i] = normals.y[i] = normals.z[i] = std::nanf("");
    }
    std::size_t attributes(const Int3&, cpu::PointList&, const AttributeNumbers&, unsigned, const cpu::NormalRows*,
                           cpu::GroupValues&, unsigned) override {
        return 0;
    }

private:
    NoiseWorld world_;
};

class NoiseSteps : public cpu::SurfaceSteps {
public:
    NoiseSteps(cpu::State& state, cpu::FieldSource& field, Mesh& mesh, const NoiseWorld& world)
        : SurfaceSteps(state, field, mesh), world_(world), levels_(noise_levels(world)) {
        if (world.keeps_slivers) slivers_ = Slivers::kept;
    }

    void register_particles() {
        for (int i = 0; i < 8; ++i) {
            Brick brick;
            brick.coordinate = {i & 1, i >> 1 & 1, i >> 2};
            brick.clear();
            if (!mark_world(world_, brick.coordinate, brick.occupied)) continue;
            state_.grid.bricks.push_back(brick);
            state_.grid.keys.push_back(brick_key(brick.coordinate));
        }
        cpu::number_members(state_.grid, state_.workers);
        cpu::store_blocks(state_);
    }
    void sample_base_vertices() {
        for (std::uint32_t b = 0; b < state_.block_count(); ++b) state_.wanted_points[b] = 1;
        state_.chosen.clear();
        for (const Brick& brick : state_.grid.bricks)
            state_.chosen.insert(state_.chosen.end(), std::begin(brick.occupied), std::end(brick.occupied));
        cpu::sample_wanted_points(state_, field_, cpu::Wanted::corners);
    }
    /// As with particles, a cell may start outside the band only if its corners agree.
    void split_cells() {
        const BlocksView blocks = state_.blocks();
        for (std::uint32_t b = 0; b < state_.block_count(); ++b) {
            const ClosedCell cell(blocks, b);
            int inside = 0;
            for (const std::uint32_t corner : cell.block) inside += static_cast<int>(blocks.inside_or_none(corner) & 1);
            const bool agree = inside == 0 || inside == 8;
            state_.level[b] = !agree || levels_.starts[b] ? levels_.wanted[b] : std::uint8_t{0};
        }
        state_.bends.assign(levels_.bends.begin(), levels_.bends.begin() + state_.block_count());
        cpu::collect_level_sets(state_);
        wanted_level_ = [this](std::uint32_t block) { return levels_.wanted[block]; };
    }

private:
    NoiseWorld world_;
    NoiseLevels levels_;
};

}  // namespace

Settings noise_settings(const NoiseWorld& world) {
    Settings settings;
    settings.particle_radius = 1.0;
    settings.iso = 1.0;
    settings.mode = world.uniform ? Mode::uniform : Mode::adaptive;
    if (world.bisects) settings.edge_points = Bisection{};
    return settings;
}

NoiseLevels noise_levels(const NoiseWorld& world) {
    std::mt19937_64 random(world.seed);
    std::uniform_int_distribution<int> level(1, 3);
    std::bernoulli_distribution starts(world.band_share);
    NoiseLevels levels;
    for (int i = 0; i < world.side * world.side * world.side; ++i) {
        levels.wanted.push_back(static_cast<std::uint8_t>(world.uniform ? 3 : level(random)));
        levels.starts.push_back(starts(random));
    }
    std::uniform_real_distribution<float> trace(-4.0F, 4.0F);
    for (const std::uint8_t wanted : levels.wanted) {
        const float cubed = std::pow(trace(random), 3.0F);
        levels.bends.push_back({0.0F, std::abs(cubed) < 0.5F ? 0.0F : cubed, wanted});
    }
    return levels;
}

bool mark_world(const NoiseWorld& world, const Int3& brick, std::uint64_t* occupied) {
    const int end = world.first + world.side;
    bool any = false;
    for (int z = world.first; z < end; ++z)
        for (int y = world.first; y < end; ++y)
            for (int x = world.first; x < end; ++x) {
                if (!(brick_of({x, y, z}) == brick)) continue;
                const int index = index_in_brick({x, y, z});
                occupied[index >> 6] |= std::uint64_t{1} << (index & 63);
                any = true;
            }
    return any;
}

Mesh mesh_of_noise_on_cpu(const NoiseWorld& world) {
    const LatticeSettings settings(noise_settings(world));
    const auto account = std::make_shared<MemoryAccount>();
    cpu::Workers workers(1);
    cpu::State state(account, workers, settings);
    NoiseField field(world);
    Mesh mesh;
    mesh.cell_size = settings.cell_size;
    mesh.offset_bits = settings.offset_bits;
    NoiseSteps steps(state, field, mesh, world);
    NoClock clock;
    run_pipeline(steps, clock);
    if (world.max_level < 3) {
        Array<std::uint8_t> found;
        found.assign(state.level.begin(), state.level.end());
        cpu::cap_levels(state, found, world.max_level);
        emit_mesh(steps, clock);
    }
    cpu::keep_lattice(state, mesh);
    return mesh;
}

std::uint64_t noise_worlds(std::uint64_t count) {
    const char* const times = std::getenv("MENISCUS_NOISE_WORLDS");
    return count * (times != nullptr ? std::strtoull(times, nullptr, 10) : 1);
}

}  // namespace meniscus::test
