// Step 1 on the GPU.
#include "steps/register_particles/register_particles.hpp"

#include <bit>
#include <utility>

#include "engine/cuda/block_counter.hpp"
#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/sort_key.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/register_particles/crowd.hpp"
#include "steps/register_particles/work.hpp"

namespace meniscus::cuda {
namespace {

/// One thread: a crowded frame ends here, before it takes long; and one that the host wants no more.
__global__ void stop_if_crowded(const __grid_constant__ State state) {
    if (blockIdx.x != 0 || threadIdx.x != 0) return;
    if (state.goes_on() && is_crowded(state.counts->crowd, state.input->particles, state.settings))
        state.counts->stop = Stop::crowded;
    stop_where_asked(state);
}

__global__ void __launch_bounds__(block_threads) seed_probes(const __grid_constant__ State state) {
    __shared__ BlockCounter counter;
    Counter seed = 0;
    GridLoop{}.each(probe_count(state.particle_count()), [&](std::uint32_t i) {
        seed += key_bits(particle_key(state.keys[std::uint64_t{i} * particles_per_probe]));
    });
    counter.add(&state.counts->probe_seed, seed);
}

/// Whether the neighbors that were found for the probed particles are too many.
__device__ bool sums_are_too_much(const State& state) {
    const std::uint32_t particles = state.input->particles;
    const double even =
        even_work<EvenNeighbors>(state.settings, particles, [&](unsigned k) { return state.counts->has_level(k); });
    // Other warps add to it meanwhile.
    const Counter neighbors = *const_cast<volatile Counter*>(&state.counts->neighbors);
    return work_at_particles(neighbors, particles) > most_work(state.settings, even);
}

/// One warp for every probe.
__global__ void __launch_bounds__(block_threads) count_neighbors(const __grid_constant__ State state) {
    const std::uint32_t particles = state.particle_count();
    LongLoop loop(state);
    each_by_warp(probe_count(particles), [&](std::uint32_t probe) {
        if (!loop.goes_on_together()) return;
        if (same_in_all_lanes(sums_are_too_much(state) ? 1 : 0) != 0) return;
        const SortKey key = state.keys[probed_particle(probe, state.counts->probe_seed, particles)];
        const Units3 place = place_in_cell(particle_key(key));
        const float px = static_cast<float>(place.x), py = static_cast<float>(place.y),
                    pz = static_cast<float>(place.z);
        Counter neighbors = 0;
        for (unsigned k = 0; k < particle_level_count; ++k) {
            const ParticleSetView set = state.set(k);
            if (set.cells.brick_count == 0) continue;
            NoBrickHints hints;
            set.for_each_run_near(
                cell_corner(particle_key(key).cell, state.settings.cell_units[key_level(key)]),
                {{px, py, pz}, {px, py, pz}}, hints, [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
                    for (std::uint32_t i = begin + lane_index(); i < end; i += warp_threads) {
                        const float4 p = state.particles[i];
                        if (is_neighbor(p.x + shift[0] - px, p.y + shift[1] - py, p.z + shift[2] - pz, set.support))
                            ++neighbors;
                    }
                });
        }
        add_of_lanes(&state.counts->neighbors, neighbors);
    });
}

/// One thread: ends a frame whose sums at the particles' places are too much work.
__global__ void stop_if_sums_are_too_much(const __grid_constant__ State state) {
    if (blockIdx.x != 0 || threadIdx.x != 0 || probe_count(state.particle_count()) == 0) return;
    if (sums_are_too_much(state)) state.counts->stop = Stop::too_much_at_particles;
}

/// One thread: the same for those at the base cells.
__global__ void stop_if_base_cells_are_too_much(const __grid_constant__ State state) {
    if (blockIdx.x != 0 || threadIdx.x != 0 || !state.goes_on()) return;
    const double even = even_work<EvenNearBaseCell>(state.settings, state.count(Resource::blocks),
                                                    [&](unsigned k) { return state.counts->has_level(k); });
    double even_cells = 0.0;
    for (unsigned k = 0; k < particle_level_count; ++k) {
        const std::uint32_t begin = state.counts->first_particle_brick[k],
                            end = state.counts->first_particle_brick[k + 1];
        if (begin == end) continue;
        const std::uint32_t last_cell = end < state.count(Resource::particle_bricks) ? state.particle_bricks[end].first
                                                                                     : state.counts->particle_cells;
        state.counts->level_particles[k] =
            state.first_particle[last_cell] - state.first_particle[state.particle_bricks[begin].first];
        even_cells += even_base_cells(state.settings, k, state.counts->level_particles[k]);
    }
    if (state.count(Resource::blocks) > most_base_cells(state.settings, even_cells))
        state.counts->stop = Stop::too_many_base_cells;
    else if (static_cast<double>(state.counts->pairs) > most_work(state.settings, even))
        state.counts->stop = Stop::too_much_at_base_cells;
}

/// A brick's number in the box of all that may be reached, in the order of brick keys; and back.
__device__ std::uint64_t boxed_brick(const State& state, const Int3& brick) {
    const Int3 at = brick - state.counts->reached_low;
    const std::uint32_t* const size = state.counts->reached_size;
    return (std::uint64_t{static_cast<std::uint32_t>(at.z)} * size[1] + static_cast<std::uint32_t>(at.y)) * size[0] +
           static_cast<std::uint32_t>(at.x);
}
__device__ Int3 coordinate_of_boxed(const State& state, std::uint64_t number) {
    const std::uint32_t* const size = state.counts->reached_size;
    const std::uint64_t row = number / size[0];
    return state.counts->reached_low + Int3{static_cast<std::int32_t>(number % size[0]),
                                            static_cast<std::int32_t>(row % size[1]),
                                            static_cast<std::int32_t>(row / size[1])};
}

__global__ void __launch_bounds__(block_threads) list_reached_bricks(const __grid_constant__ State state) {
    const std::uint64_t room = state.capacity[Resource::reached_bricks];
    const auto reached_by = [&](std::uint32_t cell) {
        const SortKey key = state.keys[state.first_particle[cell]];
        const unsigned level = key_level(key);
        return reached_bricks(particle_key(key).cell, state.settings.cell_units[level], state.settings.support[level]);
    };
    // After a stop for want of room listing goes on, unless particles have not found their places.
    const auto fullest = static_cast<int>(Resource::cell_particles);
    const bool is_sorted = state.counts->needed[fullest] <= state.capacity[Resource::cell_particles];
    GridLoop{}.each_together(is_sorted ? state.counts->particle_cells : 0, [&](std::uint32_t cell, bool exists) {
        ReachedBricks reached;
        std::uint32_t count = 0;
        if (exists) {
            reached = reached_by(cell);
            // Most cells reach the same bricks as the one before.
            if (cell == 0 || !(reached == reached_by(cell - 1))) count = reached.count();
        }
        Counter at = take_places(&state.counts->needed[static_cast<int>(Resource::reached_bricks)], count);
        if (count == 0 || at + count > room) return;
        Int3 b;
        for (b.z = reached.low.z; b.z <= reached.high.z; ++b.z)
            for (b.y = reached.low.y; b.y <= reached.high.y; ++b.y)
                for (b.x = reached.low.x; b.x <= reached.high.x; ++b.x)
                    state.unsorted_reached_keys[at++] = boxed_brick(state, b);
    });
}

constexpr std::uint64_t no_brick = ~std::uint64_t{0};

/// The number of sorted keys that may name a brick.
__device__ std::uint64_t reached_key_count(const State& state) {
    const std::uint64_t listed = state.counts->needed[static_cast<int>(Resource::reached_bricks)];
    return listed < state.capacity[Resource::reached_bricks] ? listed : state.capacity[Resource::reached_bricks];
}

__device__ bool is_first_of_key(const State& state, std::uint32_t i) {
    return state.reached_keys[i] != no_brick && (i == 0 || state.reached_keys[i] != state.reached_keys[i - 1]);
}

__global__ void __launch_bounds__(block_threads) mark_first_keys(const __grid_constant__ State state) {
    GridLoop{}.each(reached_key_count(state),
                    [&](std::uint32_t i) { state.first_of_key[i] = is_first_of_key(state, i) ? 1 : 0; });
}

__global__ void __launch_bounds__(block_threads) store_bricks(const __grid_constant__ State state) {
    const std::uint64_t keys = reached_key_count(state);
    GridLoop{}.each(keys, [&](std::uint32_t i) {
        const std::uint32_t brick = state.first_of_key[i];
        if (is_first_of_key(state, i) && brick < state.capacity[Resource::bricks]) {
            const Int3 coordinate = coordinate_of_boxed(state, state.reached_keys[i]);
            state.brick_keys[brick] = brick_key(coordinate);
            state.bricks[brick].coordinate = coordinate;
            state.bricks[brick].clear();
            state.members_before[brick] = 0;
        }
    });
    if (blockIdx.x != 0 || threadIdx.x != 0) return;
    state.need(Resource::bricks, state.first_of_key[keys]);
    state.need(Resource::reached_bricks, state.counts->needed[static_cast<int>(Resource::reached_bricks)]);
}

/// Also gives the members of every brick their numbers.
__global__ void __launch_bounds__(block_threads) find_neighbors(const __grid_constant__ State state) {
    const BrickGridView grid = state.grid();
    GridLoop{}.each(std::uint64_t{neighbor_slots} * grid.brick_count, [&](std::uint32_t i) {
        const std::uint32_t b = i / neighbor_slots;
        const int n = static_cast<int>(i % neighbor_slots);
        state.neighbors[b].brick[n] = grid.find(state.bricks[b].coordinate + neighbor_offset(n));
        if (n == 0) state.bricks[b].first = static_cast<std::uint32_t>(state.members_before[b]);
        if (i == 0) state.counts->needed[static_cast<int>(Resource::blocks)] = state.members_before[grid.brick_count];
    });
    state.require_room_at_end(RoomFinder::blocks, Resource::blocks);
}

/// One warp for every word of a brick: neighboring lanes fill neighboring blocks.
__global__ void __launch_bounds__(block_threads) make_blocks(const __grid_constant__ State state) {
    each_by_warp(Brick::words * state.count(Resource::bricks), [&](std::uint32_t i) {
        const std::uint32_t b = i / Brick::words;
        const int w = static_cast<int>(i % Brick::words);
        const Brick& brick = state.bricks[b];
        const std::uint64_t members = brick.occupied[w];
        if (members == 0) return;
        const std::uint32_t first = brick.first + brick.rank[w];
        for (unsigned bit = lane_index(); bit < 64; bit += warp_threads) {
            if ((members >> bit & 1) == 0) continue;
            const int index = 64 * w + static_cast<int>(bit);
            const std::uint64_t below = members & ((std::uint64_t{1} << bit) - 1);
            const std::uint32_t block = first + static_cast<std::uint32_t>(popcount(below));
            state.brick[block] = b;
            state.place[block] = static_cast<std::uint16_t>(index);
            state.level[block] = 0;
            state.wanted_points[block] = 0;
            state.corner_points[block] = 0;
            state.particle_counts[block] = 0;
        }
    });
}

/// Counts the particles of level 0 in every stored base cell.
__global__ void __launch_bounds__(block_threads) count_particles(const __grid_constant__ State state) {
    const BrickGridView grid = state.grid();
    GridLoop{}.each(state.particle_count(), [&](std::uint32_t i) {
        if (key_level(state.keys[i]) != 0) return;
        const ParticleKey key = particle_key(state.keys[i]);
        const Units3 place = key_place(key, state.settings.cell_units[0]);
        const auto cell = [](std::int64_t p) { return static_cast<std::int32_t>(floor_div(p, units_per_base_cell)); };
        const Int3 at{cell(place.x), cell(place.y), cell(place.z)};
        const std::uint32_t brick = grid.find(brick_of(at));
        // Cells beyond the domain are not stored.
        if (brick != no_index && grid.bricks[brick].holds(index_in_brick(at)))
            atomicAdd(&state.particle_counts[grid.bricks[brick].number(index_in_brick(at))], 1U);
    });
}

void require_bearable_particles(const State& state, const Launcher& launch) {
    const std::uint64_t n = state.capacity.particles;
    if (state.settings.work_limit != 0.0) {
        const std::uint64_t probes = probe_count(n);
        launch(probes, block_threads, seed_probes, state);
        launch(probes, block_warps, count_neighbors, state);
        launch(1, block_threads, stop_if_sums_are_too_much, state);
    }
    launch(1, block_threads, stop_if_crowded, state);
}

void store_reached_bricks(State& state, const Launcher& launch) {
    const std::uint64_t keys = state.capacity[Resource::reached_bricks];
    check(cudaMemsetAsync(state.unsorted_reached_keys, 0xFF, keys * sizeof(std::uint64_t), launch.stream),
          "cudaMemsetAsync");
    launch(state.capacity.particles, block_threads, list_reached_bricks, state);
    const auto bits = static_cast<unsigned>(std::bit_width(state.capacity[Resource::reached_box] - 1));
    if (sort(state.scratch_memory(), state.unsorted_reached_keys, state.reached_keys, keys, bits, launch.stream) !=
        state.reached_keys)
        std::swap(state.reached_keys, state.unsorted_reached_keys);
    launch(keys, block_threads, mark_first_keys, state);
    exclusive_sum(state.scratch_memory(), state.first_of_key, keys + 1, launch.stream);
    launch(keys, block_threads, store_bricks, state);
}

}  // namespace

void store_blocks(const State& state, const Launcher& launch) {
    const std::uint64_t bricks = state.capacity[Resource::bricks];
    exclusive_sum(state.scratch_memory(), state.members_before, bricks + 1, launch.stream);
    launch(neighbor_slots * bricks, block_threads, find_neighbors, state);
    if (state.settings.work_limit != 0.0) launch(1, block_threads, stop_if_base_cells_are_too_much, state);
    find_neighbor_bricks(state, launch);
    launch(Brick::words * bricks, block_warps, make_blocks, state);
    if (!state.settings.part.is_whole)
        check(
            cudaMemsetAsync(state.raise_times, 0, state.capacity[Resource::blocks] * sizeof(RaiseTimes), launch.stream),
            "cudaMemsetAsync");
}

void register_particles(State& state, bool has_payload, const Launcher& launch) {
    sort_particles(state, has_payload, launch);
    require_bearable_particles(state, launch);
    if (has_payload) order_payload(state, launch);
    if (state.settings.has_own_supports) fit_supports(state, launch);
    store_reached_bricks(state, launch);
    store_reached_cells(state, launch);
    store_blocks(state, launch);
    if (state.settings.counts_particles) launch(state.capacity.particles, block_threads, count_particles, state);
    if (state.settings.divides_by_density) divide_weights_by_density(state, launch);
}

}  // namespace meniscus::cuda
