// The particles' order on the GPU, and their support cells.
//
// Particles are sorted by support cell alone: by its number in the box around all particles of its level, so that few
// bits are sorted. Those of a cell are few, and find their places by counting; equal keys are equal particles, whose
// order does not matter. Where that does not hold (Capacities::orders_whole_keys()), whole keys are sorted, by their
// lower halves and then by their upper ones.
#include <algorithm>
#include <bit>
#include <utility>

#include "engine/cuda/block_counter.hpp"
#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/sort_key.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/register_particles/count_by_warp.hpp"
#include "steps/register_particles/register_particles.hpp"

namespace meniscus::cuda {
namespace {

constexpr unsigned box_bounds = sizeof(BrickBox) / sizeof(std::uint32_t);
constexpr std::uint64_t last_key = ~std::uint64_t{0};

/// Gives every level's box its numbers, and lays the box around all that they may reach; by one thread, after all
/// particles are in the boxes.
__device__ void lay_boxes(const State& state) {
    std::uint64_t boxed = 0;
    Int3 low, high;
    for (unsigned k = 0; k < particle_level_count; ++k) {
        state.counts->boxed_before[k] = boxed;
        BrickBox box;
        // Other blocks have filled it.
        for (int axis = 0; axis < 3; ++axis) {
            box.below[axis] = *const_cast<volatile std::uint32_t*>(&state.counts->boxes[k].below[axis]);
            box.end[axis] = *const_cast<volatile std::uint32_t*>(&state.counts->boxes[k].end[axis]);
        }
        if (box.volume() == 0) continue;
        const auto cell = [&](const auto& axis_at, std::uint64_t index) {
            const std::uint64_t rows = std::uint64_t{axis_at(2)} << brick_axis_bits | axis_at(1);
            return (rows << brick_axis_bits | axis_at(0)) << brick_index_bits | index;
        };
        const std::int64_t cell_units = state.settings.cell_units[k];
        const float support = state.settings.support[k];
        const ReachedBricks lowest =
            reached_bricks(cell([&](int axis) { return box.low(axis); }, 0), cell_units, support);
        const ReachedBricks highest =
            reached_bricks(cell([&](int axis) { return box.end[axis] - 1; }, brick_volume - 1), cell_units, support);
        if (boxed == 0) {
            low = lowest.low;
            high = highest.high;
        }
        low = {std::min(low.x, lowest.low.x), std::min(low.y, lowest.low.y), std::min(low.z, lowest.low.z)};
        high = {std::max(high.x, highest.high.x), std::max(high.y, highest.high.y), std::max(high.z, highest.high.z)};
        boxed += box.volume();
    }
    state.counts->reached_low = low;
    state.counts->reached_size[0] = static_cast<std::uint32_t>(high.x - low.x + 1);
    state.counts->reached_size[1] = static_cast<std::uint32_t>(high.y - low.y + 1);
    state.counts->reached_size[2] = static_cast<std::uint32_t>(high.z - low.z + 1);
    state.need(Resource::reached_box, std::uint64_t{state.counts->reached_size[0]} * state.counts->reached_size[1] *
                                          state.counts->reached_size[2]);
    if (!state.capacity.orders_whole_keys()) state.need(Resource::boxed_bricks, boxed);
}

/// One side of a box, in shared memory, grows to hold a particle; most particles lie inside already.
__device__ void grow(std::uint32_t& bound, std::uint32_t least) {
    if (look_among_atomics(bound) < least) atomicMax(&bound, least);
}

/// Also lays a box of bricks around the particles of each level.
__global__ void __launch_bounds__(block_threads) make_keys(const __grid_constant__ State state) {
    __shared__ std::uint32_t bounds[particle_level_count * box_bounds];
    if (threadIdx.x < particle_level_count * box_bounds) bounds[threadIdx.x] = 0;
    __syncthreads();
    GridLoop{}.each(state.input->particles, [&](std::uint32_t i) {
        const unsigned level = state.input->levels == nullptr ? 0 : state.input->levels[i];
        const ParticleKey key =
            meniscus::particle_key(state.input->positions.snapped(i), state.settings.cell_units[level]);
        state.unsorted_keys[i] = sort_key(level, key);
        std::uint64_t brick = key.cell >> brick_index_bits;
        for (unsigned axis = 0; axis < 3; ++axis, brick >>= brick_axis_bits) {
            const std::uint32_t at = static_cast<std::uint32_t>(brick) & (BrickBox::axis_end - 1);
            grow(bounds[level * box_bounds + axis], BrickBox::axis_end - at);
            grow(bounds[level * box_bounds + 3 + axis], at + 1);
        }
    });
    __syncthreads();
    if (warp_in_block() != 0) return;
    if (lane_index() < particle_level_count * box_bounds && bounds[lane_index()] != 0)
        atomicMax(state.counts->boxes[0].below + lane_index(), bounds[lane_index()]);
    // The last block finds the bounds of all blocks.
    __threadfence();
    __syncwarp();
    if (lane_index() == 0 && atomicAdd(&state.counts->boxed_blocks, 1U) == gridDim.x - 1) lay_boxes(state);
}

/// The part of a key by which is sorted.
enum class KeyPart : std::uint8_t { cell, lower_half, upper_half };

/// A support cell's number in the boxes of all levels, in the order of keys.
__device__ std::uint64_t boxed_cell(const State& state, SortKey key) {
    const unsigned level = key_level(key);
    const std::uint64_t cell = particle_key(key).cell;
    const std::uint64_t bricks = cell >> brick_index_bits;
    const BrickBox& box = state.counts->boxes[level];
    const auto from_low = [&](int axis) {
        return (static_cast<std::uint32_t>(bricks >> axis * brick_axis_bits) & (BrickBox::axis_end - 1)) -
               box.low(axis);
    };
    const std::uint64_t number = (from_low(2) * box.size(1) + from_low(1)) * box.size(0) + from_low(0);
    return (state.counts->boxed_before[level] + number) << brick_index_bits | (cell & (brick_volume - 1));
}

/// keys: for CUB. Whatever lies behind the particles stays there.
__global__ void __launch_bounds__(block_threads)
    store_key_part(const __grid_constant__ State state, std::uint64_t* keys, KeyPart part) {
    const std::uint32_t n = state.particle_count();
    GridLoop{}.each(state.capacity.particles, [&](std::uint32_t i) {
        const std::uint32_t source = part == KeyPart::upper_half ? state.order[i] : i;
        if (part != KeyPart::upper_half) state.order[i] = i;
        if (source >= n)
            keys[i] = last_key;
        else if (part == KeyPart::cell)
            keys[i] = boxed_cell(state, state.unsorted_keys[source]);
        else
            keys[i] = static_cast<std::uint64_t>(state.unsorted_keys[source] >> (part == KeyPart::lower_half ? 0 : 64));
    });
}

/// Whether two keys name the same support cell.
__device__ bool share_cell(SortKey a, SortKey b) {
    return (a ^ b) >> place_bits == 0;
}

/// Puts the keys in order of their cells; marks where a support cell begins, and where a brick of them does.
__global__ void __launch_bounds__(block_threads) mark_starts(const __grid_constant__ State state) {
    GridLoop{}.each(state.particle_count(), [&](std::uint32_t i) {
        const SortKey key = state.unsorted_keys[state.order[i]];
        const SortKey before = i == 0 ? ~key : state.unsorted_keys[state.order[i - 1]];
        state.keys[i] = key;
        state.starts[i] = (share_cell(key, before) ? 0 : 1) |
                          static_cast<std::uint64_t>((key ^ before) >> (place_bits + brick_index_bits) == 0 ? 0 : 1)
                              << 32;
    });
}

/// Stores the support cells and the bricks of these.
__global__ void __launch_bounds__(block_threads) store_support_cells(const __grid_constant__ State state) {
    const std::uint32_t n = state.particle_count();
    const std::uint64_t most_bricks = state.capacity[Resource::particle_bricks];
    GridLoop{}.each(n, [&](std::uint32_t i) {
        const std::uint64_t before = state.starts[i];
        const std::uint64_t with_own = state.starts[i + 1];
        const std::uint32_t cell = static_cast<std::uint32_t>(with_own) - 1;
        const std::uint32_t brick = static_cast<std::uint32_t>(with_own >> 32) - 1;
        const unsigned level = key_level(state.keys[i]);
        if (static_cast<std::uint32_t>(before) == cell) {
            state.first_particle[cell] = i;
            const std::uint64_t cell_key = particle_key(state.keys[i]).cell;
            const int index = key_index(cell_key);
            const bool begins_brick = static_cast<std::uint32_t>(before >> 32) == brick;
            if (brick < most_bricks) {
                Brick& stored = state.particle_bricks[brick];
                atomicOr(reinterpret_cast<Counter*>(&stored.occupied[index >> 6]), Counter{1} << (index & 63));
                if (begins_brick) {
                    stored.coordinate = key_brick(cell_key);
                    stored.first = cell;
                    state.particle_brick_keys[brick] = brick_key(key_brick(cell_key));
                }
            }
            // A level's bricks begin where the level's particles do; levels without particles have none.
            if (begins_brick)
                for (unsigned k = i == 0 ? 0 : key_level(state.keys[i - 1]) + 1; k <= level; ++k)
                    state.counts->first_particle_brick[k] = brick;
        }
        if (i == n - 1) {
            for (unsigned k = level + 1; k <= particle_level_count; ++k)
                state.counts->first_particle_brick[k] = brick + 1;
            state.first_particle[cell + 1] = n;
            state.counts->particle_cells = cell + 1;
            state.counts->needed[static_cast<int>(Resource::particle_bricks)] = brick + 1;
        }
    });
    state.require_room_at_end(RoomFinder::support_cells, Resource::particle_bricks);
}

/// A particle's place in the order of its level, among those of its cell by counting.
__device__ std::uint32_t place_in_order(const State& state, std::uint32_t i, std::uint32_t begin, std::uint32_t end) {
    if (state.capacity.orders_whole_keys()) return i;
    if (end - begin > Capacities::most_counted_in_cell) {
        atomicMax(&state.counts->needed[static_cast<int>(Resource::cell_particles)], Counter{end - begin});
        return i;
    }
    // In a cell, keys differ in their lower halves. Equal ones stay in their order.
    const auto key = [&](std::uint32_t j) { return static_cast<std::uint64_t>(state.keys[j]); };
    const std::uint64_t own = key(i);
    std::uint32_t place = begin;
    for (std::uint32_t j = begin; j < end; ++j)
        if (key(j) < own + (j < i ? 1 : 0)) ++place;
    return place;
}

/// Puts the particles in their order, their keys in the place of the unsorted ones. Counts the bricks' words, and how
/// crowded the cells are.
__global__ void __launch_bounds__(block_threads)
    store_particles(const __grid_constant__ State state, bool has_payload) {
    __shared__ BlockCounter counter;
    each_by_warp(state.count(Resource::particle_bricks),
                 [&](std::uint32_t b) { count_by_warp(state.particle_bricks[b]); });
    Counter crowd = 0;
    // Where only bricks lack room, the frame goes on to find what else lacks it.
    GridLoop{}.each(state.counts->particle_cells == 0 ? 0 : state.input->particles, [&](std::uint32_t i) {
        const SortKey key = state.keys[i];
        const auto cell = static_cast<std::uint32_t>(state.starts[i + 1]) - 1;
        const std::uint32_t begin = state.first_particle[cell];
        const std::uint32_t end = state.first_particle[cell + 1];
        crowd += end - begin;
        const std::uint32_t place = place_in_order(state, i, begin, end);
        float4 p{0.0F, 0.0F, 0.0F, state.settings.weight};
        key_position(particle_key(key), state.settings.cell_units[key_level(key)], p.x, p.y, p.z);
        state.unsorted_keys[place] = key;
        state.particles[place] = p;
        if (has_payload) state.sources[place] = state.order[i];
    });
    counter.add(&state.counts->crowd, crowd);
    state.require_room_at_end(RoomFinder::particles, Resource::cell_particles);
}

/// Sorts each run of equal keys by payload, one thread a run. Runs after stop_if_crowded, which bounds a run to about
/// the root of 1024 n particles: a heap sort of these by one thread may still take long on a GPU.
__global__ void __launch_bounds__(block_threads, 4) order_by_payload(const __grid_constant__ State state) {
    const std::uint32_t n = state.particle_count();
    LongLoop loop(state);
    GridLoop{}.each(n, [&](std::uint32_t i) {
        if (!loop.goes_on()) return;
        const SortKey key = state.keys[i];
        if (i > 0 && state.keys[i - 1] == key) return;
        std::uint32_t end = i + 1;
        while (end < n && state.keys[end] == key) ++end;
        if (end > i + 1) sort_by_payload(state.input->payload, state.sources + i, end - i);
    });
}

/// Stores the numbers of the sorted particles that vertices need.
__global__ void __launch_bounds__(block_threads) store_numbers(const __grid_constant__ State state, unsigned group) {
    const AttributeNumber* const numbers = state.input->attributes.group(group);
    GridLoop{}.each(state.particle_count(), [&](std::uint32_t i) {
        float of_particle[group_size_of_numbers] = {};
        for (unsigned k = 0; k < group_size_of_numbers; ++k)
            if (k < state.attributes.count(group))
                of_particle[k] = numbers[k].of_particle(state.input->payload.data[numbers[k].array], state.sources[i]);
        state.numbers[group * state.capacity.particles + i] = {of_particle[0], of_particle[1], of_particle[2],
                                                               of_particle[3]};
    });
}

/// Sorts State::order. CUB's keys lie in the room of the particles, which come later.
void sort_order(State& state, const Launcher& launch) {
    const std::uint64_t n = state.capacity.particles;
    auto* const first_keys = reinterpret_cast<std::uint64_t*>(state.particles);
    const auto sort_by = [&](KeyPart part, unsigned bits) {
        launch(n, block_threads, store_key_part, state, first_keys, part);
        const SortedPairs sorted = sort_with_values(state.scratch_memory(), {first_keys, state.order},
                                                    {first_keys + n, state.order_room}, n, bits, launch.stream);
        if (sorted.values != state.order) std::swap(state.order, state.order_room);
    };
    if (state.capacity.orders_whole_keys()) {
        sort_by(KeyPart::lower_half, 64);
        sort_by(KeyPart::upper_half, 64);
    } else {
        const std::uint64_t cells = state.capacity[Resource::boxed_bricks] << brick_index_bits;
        sort_by(KeyPart::cell, static_cast<unsigned>(std::bit_width(cells - 1)));
    }
}

}  // namespace

void sort_particles(State& state, bool has_payload, const Launcher& launch) {
    const std::uint64_t n = state.capacity.particles;
    launch(n, block_threads, make_keys, state);
    sort_order(state, launch);
    launch(n, block_threads, mark_starts, state);
    exclusive_sum(state.scratch_memory(), state.starts, n + 1, launch.stream);
    check(cudaMemsetAsync(state.particle_bricks, 0, state.capacity[Resource::particle_bricks] * sizeof(Brick),
                          launch.stream),
          "cudaMemsetAsync");
    launch(n, block_threads, store_support_cells, state);
    launch(n, block_threads, store_particles, state, has_payload);
    std::swap(state.keys, state.unsorted_keys);
}

void order_payload(const State& state, const Launcher& launch) {
    const std::uint64_t n = state.capacity.particles;
    launch(n, block_threads, order_by_payload, state);
    for (unsigned group = 0; group < state.attributes.groups(); ++group)
        launch(n, block_threads, store_numbers, state, group);
}

}  // namespace meniscus::cuda
