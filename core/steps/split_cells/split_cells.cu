// Step 2 on the GPU.
#include "steps/split_cells/split_cells.hpp"

#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

/// A word of a brick that all lanes of a warp look at: half a word at a time, a lane for every bit.
struct WordOfLanes {
    std::uint32_t number;   ///< index among the words of all bricks
    std::uint64_t members;  ///< members of the brick
    std::uint32_t first;    ///< number of the first member, or of the next one after the word

    __device__ static int bit(int half) { return static_cast<int>(lane_index()) + 32 * half; }
    __device__ bool holds(int bit) const { return (members >> bit & 1) != 0; }
    /// Meaningful where the bit is a member.
    __device__ std::uint32_t block(int bit) const {
        return first + static_cast<std::uint32_t>(popcount(members & ((std::uint64_t{1} << bit) - 1)));
    }
};

/// Calls visit(word) for the words of all bricks, each by all lanes of a warp.
template <class Visit>
__device__ void each_word_by_warp(const State& state, const Visit& visit) {
    each_by_warp(Brick::words * state.count(Resource::bricks), [&](std::uint32_t i) {
        const Brick& brick = state.bricks[i / Brick::words];
        const std::uint32_t w = i % Brick::words;
        visit(WordOfLanes{i, brick.occupied[w], brick.first + brick.rank[w]});
    });
}

/// The same in all lanes: each looks up one corner in one set.
__device__ CornerSets corner_sets_together(const BaseVertexSets& vertices, std::uint32_t brick, int w) {
    const int i = static_cast<int>(lane_index());
    const Int3 corner{i & 1, i >> 1 & 1, i >> 2 & 1};
    const bool is_deep = (i & 8) != 0;
    const CellSetView set{vertices.inside.grid, is_deep ? vertices.deep.words : vertices.inside.words};
    // All are deep where none is not.
    std::uint64_t any = set.moved(brick, w, corner) ^ (is_deep ? ~std::uint64_t{0} : 0);
    for (int distance = 4; distance > 0; distance /= 2) any |= __shfl_xor_sync(all_lanes, any, distance);
    CornerSets sets;
    sets.any_inside = __shfl_sync(all_lanes, any, 0);
    sets.all_deep = ~__shfl_sync(all_lanes, any, 8);
    return sets;
}

/// All words: those without a member are neighbors of others.
__global__ void __launch_bounds__(block_threads) collect_base_vertices(const __grid_constant__ State state) {
    const BlocksView blocks = state.blocks();
    const BandTest test{state.settings.iso, state.settings.deep_inside};
    each_word_by_warp(state, [&](const WordOfLanes& word) {
        for (int half = 0; half < 2; ++half) {
            const int bit = WordOfLanes::bit(half);
            const std::uint32_t block = word.block(bit);
            const bool inside = word.holds(bit) && (blocks.inside[block] & 1) != 0;
            const bool deep = inside && test.is_deep(blocks.value(block, 0));
            const std::uint32_t all_inside = __ballot_sync(all_lanes, inside ? 1 : 0);
            const std::uint32_t all_deep = __ballot_sync(all_lanes, deep ? 1 : 0);
            if (lane_index() != 0) continue;
            // The lower half of a word comes first in memory.
            const std::uint64_t at = 2 * std::uint64_t{word.number} + static_cast<unsigned>(half);
            reinterpret_cast<std::uint32_t*>(state.base_inside)[at] = all_inside;
            reinterpret_cast<std::uint32_t*>(state.base_deep)[at] = all_deep;
        }
    });
}

/// Cells of the band get level 1.
__global__ void __launch_bounds__(block_threads, 4) find_band(const __grid_constant__ State state, bool bends) {
    const BaseVertexSets vertices{{state.grid(), state.base_inside}, {state.grid(), state.base_deep}};
    const BandTest test{state.settings.iso, state.settings.deep_inside};
    each_word_by_warp(state, [&](const WordOfLanes& word) {
        if (word.members == 0) return;
        const CornerSets corners =
            corner_sets_together(vertices, word.number / Brick::words, static_cast<int>(word.number % Brick::words));
        const std::uint64_t settling = state.settings.part.settling_word(
            state.bricks[word.number / Brick::words].coordinate, static_cast<int>(word.number % Brick::words));
        for (int half = 0; half < 2; ++half) {
            const int bit = WordOfLanes::bit(half);
            const std::uint32_t block = word.block(bit);
            const bool exists = word.holds(bit);
            const bool in_band =
                exists && (settling >> bit & 1) != 0 && corners.may_hold_surface(bit, test, state.reaches[block].bound);
            if (exists) state.level[block] = in_band ? 1 : 0;
            if (exists && bends) state.bends[block] = {0.0F, 0.0F, 1};
        }
    });
}

template <class Rule>
__global__ void __launch_bounds__(block_threads)
    choose_levels(const __grid_constant__ State state, const Rule level_of) {
    const BlocksView blocks = state.blocks();
    GridLoop{}.each(blocks.count, [&](std::uint32_t b) {
        state.wanted_level[b] = static_cast<std::uint8_t>(level_of(blocks, b));
        if (state.level[b] != 0) state.level[b] = state.wanted_level[b];
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
