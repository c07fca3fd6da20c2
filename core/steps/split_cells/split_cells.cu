// Step 2 on the GPU.
#include "steps/split_cells/split_cells.hpp"

#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

/// Calls visit(word's number, its members, bit, block) for the words of bricks with members, each by all lanes of a
/// warp: half a word at a time, a lane for every bit. `block` is meaningful where the bit is a member.
template <class Visit>
__device__ void each_word_by_warp(const State& f, const Visit& visit) {
    each_by_warp(Brick::words * f.count(Resource::bricks), [&](std::uint32_t i) {
        const Brick& brick = f.bricks[i / Brick::words];
        const int w = static_cast<int>(i % Brick::words);
        const std::uint64_t members = brick.occupied[w];
        for (int half = 0; half < 2; ++half) {
            const int bit = static_cast<int>(lane_index()) + 32 * half;
            const auto before = static_cast<std::uint32_t>(popcount(members & ((std::uint64_t{1} << bit) - 1)));
            visit(i, members, bit, brick.first + brick.rank[w] + before);
        }
    });
}

/// All words: those without a member are neighbors of others.
__global__ void __launch_bounds__(block_threads) collect_base_vertices(const __grid_constant__ State f) {
    const BlocksView blocks = f.blocks();
    const BandTest test{f.settings.iso, f.settings.deep_inside};
    each_word_by_warp(f, [&](std::uint32_t word, std::uint64_t members, int bit, std::uint32_t block) {
        const bool exists = (members >> bit & 1) != 0;
        const bool inside = exists && (blocks.inside[block] & 1) != 0;
        const bool deep = inside && test.is_deep(blocks.value(block, 0));
        const std::uint32_t all_inside = __ballot_sync(all_lanes, inside ? 1 : 0);
        const std::uint32_t all_deep = __ballot_sync(all_lanes, deep ? 1 : 0);
        if (lane_index() != 0) return;
        // The lower half of a word comes first in memory.
        const std::uint64_t half = 2 * std::uint64_t{word} + (bit != 0 ? 1 : 0);
        reinterpret_cast<std::uint32_t*>(f.base_inside)[half] = all_inside;
        reinterpret_cast<std::uint32_t*>(f.base_deep)[half] = all_deep;
    });
}

/// Cells of the band get level 1.
__global__ void __launch_bounds__(block_threads, 4) find_band(const __grid_constant__ State f, bool bends) {
    const BaseVertexSets vertices{{f.grid(), f.base_inside}, {f.grid(), f.base_deep}};
    const BandTest test{f.settings.iso, f.settings.deep_inside};
    each_word_by_warp(f, [&](std::uint32_t word, std::uint64_t members, int bit, std::uint32_t block) {
        if (members == 0) return;
        const CornerSets corners(vertices, word / Brick::words, static_cast<int>(word % Brick::words));
        const bool exists = (members >> bit & 1) != 0;
        const bool in_band = exists && corners.may_hold_surface(bit, test, f.reaches[block].bound);
        if (exists) f.level[block] = in_band ? 1 : 0;
        if (!bends) return;
        if (exists) f.bends[block] = {0.0F, 1};
        const std::uint32_t at = take_places(&f.counts->listed[static_cast<int>(List::bends)], in_band ? 1 : 0);
        if (in_band) f.chosen[at] = block;
    });
}

template <class Rule>
__global__ void __launch_bounds__(block_threads) choose_levels(const __grid_constant__ State f, const Rule level_of) {
    const BlocksView blocks = f.blocks();
    GridLoop{}.each(blocks.count, [&](std::uint32_t b) {
        f.wanted_level[b] = static_cast<std::uint8_t>(level_of(blocks, b));
        if (f.level[b] != 0) f.level[b] = f.wanted_level[b];
    });
}

}  // namespace

void split_cells(const State& state, bool has_particle_levels, const Launcher& launch) {
    const LatticeSettings& settings = state.settings;
    const std::uint64_t blocks = state.capacity[Resource::blocks];
    const std::uint64_t words = Brick::words * state.capacity[Resource::bricks];
    launch(words, block_warps, collect_base_vertices, state);
    launch(words, block_warps, find_band, state, settings.measures_bends);
    if (settings.measures_bends) {
        measure_bends(state, launch);
        launch(blocks, block_threads, choose_levels<CurvatureRule>, state,
               CurvatureRule{state.bends, settings.tolerance});
    } else if (settings.counts_particles) {
        launch(blocks, block_threads, choose_levels<CountRule>, state,
               CountRule{state.particle_counts, settings.count_threshold, has_particle_levels});
    } else {
        launch(blocks, block_threads, choose_levels<UniformRule>, state, UniformRule{});
    }
    collect_level_sets(state, launch);
}

}  // namespace meniscus::cuda
