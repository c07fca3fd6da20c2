// A coarser surface from the samples of a finer one.
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

/// One thread: nothing is counted from step 5 on, and what was counted last may have found too little room for the
/// mesh.
__global__ void count_anew(const __grid_constant__ State state) {
    if (blockIdx.x != 0 || threadIdx.x != 0) return;
    Counts& counts = *state.counts;
    for (const Resource r : {Resource::vertices, Resource::triangles, Resource::lattice_blocks})
        counts.needed[static_cast<int>(r)] = 0;
    for (const List l : {List::vertices, List::band, List::cracks}) counts.listed[static_cast<int>(l)] = 0;
    for (std::size_t level = 0; level < triangle_level_count; ++level) counts.triangles[level] = 0;
    for (std::uint32_t& cells : counts.band_cells) cells = 0;
    counts.stop = Stop::none;
}

/// The split criterion's levels are no longer needed: their array keeps those that the frame found.
__global__ void __launch_bounds__(block_threads)
    cap_each(const __grid_constant__ State state, int max_level, bool first) {
    const auto cap = static_cast<std::uint8_t>(max_level);
    GridLoop{}.each(state.count(Resource::blocks), [&](std::uint32_t b) {
        if (first) state.wanted_level[b] = state.level[b];
        const std::uint8_t found = state.wanted_level[b];
        state.level[b] = found < cap ? found : cap;
    });
    // These are of vertices for which there was no room.
    GridLoop{}.each(std::uint64_t{cluster_words} * state.count(Resource::bricks),
                    [&](std::uint32_t i) { state.marked_clusters[i] = 0; });
}

}  // namespace

void cap_levels(const State& state, int max_level, bool first, const Launcher& launch) {
    launch(1, block_threads, count_anew, state);
    launch(state.capacity[Resource::blocks], block_threads, cap_each, state, max_level, first);
}

}  // namespace meniscus::cuda
