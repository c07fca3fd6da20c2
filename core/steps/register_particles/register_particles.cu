// Step 1 on the GPU: particles are sorted as keys and read back from them.
#include "steps/register_particles/register_particles.hpp"

#include <utility>

#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/sort_key.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/register_particles/crowd.hpp"
#include "steps/register_particles/work.hpp"

namespace meniscus::cuda {
namespace {

__global__ void __launch_bounds__(block_threads) make_keys(const __grid_constant__ State f, bool identified) {
    const std::uint32_t n = f.input->particles;
    GridLoop{}.each(f.capacity.particles, [&](std::uint32_t i) {
        if (identified) f.sources[i] = i;
        if (i >= n) {
            f.unsorted_keys[i] = no_key;
            return;
        }
        const unsigned level = f.input->levels == nullptr ? 0 : f.input->levels[i];
        f.unsorted_keys[i] =
            sort_key(level, meniscus::particle_key(f.input->positions.snapped(i), f.settings.cell_units[level]));
    });
}

/// Sorts each run of equal keys by payload, one thread a run. Runs after stop_if_crowded, which bounds a run to about
/// the root of 1024 n particles: a heap sort of these by one thread may still take long on a GPU.
__global__ void __launch_bounds__(block_threads, 4) order_by_payload(const __grid_constant__ State f) {
    const std::uint32_t n = f.particle_count();
    LongLoop loop(f);
    GridLoop{}.each(n, [&](std::uint32_t i) {
        if (!loop.goes_on()) return;
        const SortKey key = f.keys[i];
        if (i > 0 && f.keys[i - 1] == key) return;
        std::uint32_t end = i + 1;
        while (end < n && f.keys[end] == key) ++end;
        if (end > i + 1) sort_by_payload(f.input->payload, f.sources + i, end - i);
    });
}

/// What vertices ask of the sorted particles.
__global__ void __launch_bounds__(block_threads) store_numbers(const __grid_constant__ State f, unsigned group) {
    const AttributeNumber* const numbers = f.input->attributes.group(group);
    GridLoop{}.each(f.particle_count(), [&](std::uint32_t i) {
        float of_particle[group_size_of_numbers] = {};
        for (unsigned k = 0; k < group_size_of_numbers; ++k)
            if (k < f.attributes.count(group))
                of_particle[k] = numbers[k].of_particle(f.input->payload.data[numbers[k].array], f.sources[i]);
        f.numbers[group * f.capacity.particles + i] = {of_particle[0], of_particle[1], of_particle[2], of_particle[3]};
    });
}

/// Whether a support cell, and whether a brick of them, begins with this particle.
struct Begins {
    bool cell, brick;
    __device__ Begins(const SortKey* keys, std::uint32_t i)
        : cell(i == 0 || keys[i] >> place_bits != keys[i - 1] >> place_bits),
          brick(i == 0 ||
                keys[i] >> (place_bits + brick_index_bits) != keys[i - 1] >> (place_bits + brick_index_bits)) {}
};

__global__ void __launch_bounds__(block_threads) mark_starts(const __grid_constant__ State f) {
    const std::uint32_t n = f.input->particles;
    GridLoop{}.each(n, [&](std::uint32_t i) {
        const Begins begins(f.keys, i);
        f.starts[i] = (begins.cell ? 1 : 0) | static_cast<std::uint64_t>(begins.brick ? 1 : 0) << 32;
    });
}

__global__ void __launch_bounds__(block_threads) store_particles(const __grid_constant__ State f) {
    const std::uint32_t n = f.input->particles;
    const std::uint64_t most_bricks = f.capacity[Resource::particle_bricks];
    GridLoop{}.each(n, [&](std::uint32_t i) {
        const unsigned level = key_level(f.keys[i]);
        const ParticleKey key = particle_key(f.keys[i]);
        float4 p{0.0F, 0.0F, 0.0F, f.settings.weight};
        key_position(key, f.settings.cell_units[level], p.x, p.y, p.z);
        f.particles[i] = p;

        const Begins begins(f.keys, i);
        const std::uint32_t cell = static_cast<std::uint32_t>(f.starts[i]) + (begins.cell ? 1 : 0) - 1;
        const std::uint32_t brick = static_cast<std::uint32_t>(f.starts[i] >> 32) + (begins.brick ? 1 : 0) - 1;
        if (begins.cell) f.first_particle[cell] = i;
        if (begins.cell && brick < most_bricks) {
            const int index = key_index(key.cell);
            atomicOr(reinterpret_cast<Counter*>(&f.particle_bricks[brick].occupied[index >> 6]),
                     Counter{1} << (index & 63));
        }
        if (begins.brick && brick < most_bricks) {
            f.particle_bricks[brick].coordinate = key_brick(key.cell);
            f.particle_bricks[brick].first = cell;
            f.particle_brick_keys[brick] = brick_key(key_brick(key.cell));
        }
        // A level's bricks begin where the level's particles do; levels without particles have none.
        if (begins.brick)
            for (unsigned k = i == 0 ? 0 : key_level(f.keys[i - 1]) + 1; k <= level; ++k)
                f.counts->first_particle_brick[k] = brick;
        if (i == n - 1) {
            for (unsigned k = level + 1; k <= particle_level_count; ++k) f.counts->first_particle_brick[k] = brick + 1;
            f.first_particle[cell + 1] = n;
            f.counts->particle_cells = cell + 1;
            f.need(Resource::particle_bricks, brick + 1);
        }
    });
}

__global__ void __launch_bounds__(block_threads) count_support_cells(const __grid_constant__ State f) {
    GridLoop{}.each(f.count(Resource::particle_bricks), [&](std::uint32_t b) { f.particle_bricks[b].count(); });
}

__global__ void __launch_bounds__(block_threads) measure_crowd(const __grid_constant__ State f) {
    Counter crowd = 0;
    GridLoop{}.each_together(f.counts->particle_cells, [&](std::uint32_t cell, bool exists) {
        const Counter particles = exists ? f.first_particle[cell + 1] - f.first_particle[cell] : 0;
        crowd += particles * particles;
    });
    add_of_lanes(&f.counts->crowd, crowd);
}

/// One thread: a crowded frame ends here, before it takes long.
__global__ void stop_if_crowded(const __grid_constant__ State f) {
    if (blockIdx.x == 0 && threadIdx.x == 0 && f.goes_on() &&
        is_crowded(f.counts->crowd, f.input->particles, f.settings))
        f.counts->stop = Stop::crowded;
}

__global__ void __launch_bounds__(block_threads) seed_probes(const __grid_constant__ State f) {
    Counter seed = 0;
    GridLoop{}.each_together(probe_count(f.particle_count()), [&](std::uint32_t i, bool exists) {
        if (exists) seed += key_bits(particle_key(f.keys[std::uint64_t{i} * particles_per_probe]));
    });
    add_of_lanes(&f.counts->probe_seed, seed);
}

/// Whether what has been found near the probed particles is too much.
__device__ bool sums_are_too_much(const State& f) {
    const std::uint32_t particles = f.input->particles;
    const double even =
        even_work<EvenNeighbors>(f.settings, particles, [&](unsigned k) { return f.counts->has_level(k); });
    // Other warps are adding.
    const Counter neighbors = *const_cast<volatile Counter*>(&f.counts->neighbors);
    return work_at_particles(neighbors, particles) > most_work(f.settings, even);
}

/// One warp for every probe.
__global__ void __launch_bounds__(block_threads) count_neighbors(const __grid_constant__ State f) {
    const std::uint32_t particles = f.particle_count();
    LongLoop loop(f);
    each_by_warp(probe_count(particles), [&](std::uint32_t probe) {
        if (!loop.goes_on_together()) return;
        if (same_in_all_lanes(sums_are_too_much(f) ? 1 : 0) != 0) return;
        const SortKey key = f.keys[probed_particle(probe, f.counts->probe_seed, particles)];
        const Units3 place = place_in_cell(particle_key(key));
        const float px = static_cast<float>(place.x), py = static_cast<float>(place.y),
                    pz = static_cast<float>(place.z);
        Counter neighbors = 0;
        for (unsigned k = 0; k < particle_level_count; ++k) {
            const ParticleSetView set = f.set(k);
            if (set.cells.brick_count == 0) continue;
            NoBrickHints hints;
            set.for_each_run_near(
                cell_corner(particle_key(key).cell, f.settings.cell_units[key_level(key)]),
                {{px, py, pz}, {px, py, pz}}, hints, [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
                    for (std::uint32_t i = begin + lane_index(); i < end; i += warp_threads) {
                        const float4 p = f.particles[i];
                        if (is_neighbor(p.x + shift[0] - px, p.y + shift[1] - py, p.z + shift[2] - pz, set.support))
                            ++neighbors;
                    }
                });
        }
        add_of_lanes(&f.counts->neighbors, neighbors);
    });
}

/// One thread: ends a frame whose sums at the particles' places are too much work.
__global__ void stop_if_sums_are_too_much(const __grid_constant__ State f) {
    if (blockIdx.x != 0 || threadIdx.x != 0 || probe_count(f.particle_count()) == 0) return;
    if (sums_are_too_much(f)) f.counts->stop = Stop::too_much_at_particles;
}

/// One thread: the same for those at the base cells.
__global__ void stop_if_base_cells_are_too_much(const __grid_constant__ State f) {
    if (blockIdx.x != 0 || threadIdx.x != 0 || !f.goes_on()) return;
    const double even = even_work<EvenNearBaseCell>(f.settings, f.count(Resource::blocks),
                                                    [&](unsigned k) { return f.counts->has_level(k); });
    double even_cells = 0.0;
    for (unsigned k = 0; k < particle_level_count; ++k) {
        const std::uint32_t begin = f.counts->first_particle_brick[k], end = f.counts->first_particle_brick[k + 1];
        if (begin == end) continue;
        const std::uint32_t last_cell =
            end < f.count(Resource::particle_bricks) ? f.particle_bricks[end].first : f.counts->particle_cells;
        f.counts->level_particles[k] = f.first_particle[last_cell] - f.first_particle[f.particle_bricks[begin].first];
        even_cells += even_base_cells(f.settings, k, f.counts->level_particles[k]);
    }
    if (f.count(Resource::blocks) > most_base_cells(f.settings, even_cells))
        f.counts->stop = Stop::too_many_base_cells;
    else if (static_cast<double>(f.counts->pairs) > most_work(f.settings, even))
        f.counts->stop = Stop::too_much_at_base_cells;
}

__global__ void __launch_bounds__(block_threads) list_reached_bricks(const __grid_constant__ State f) {
    const std::uint64_t room = f.capacity[Resource::reached_bricks];
    const auto reached_by = [&](std::uint32_t cell) {
        const SortKey key = f.keys[f.first_particle[cell]];
        const unsigned level = key_level(key);
        return reached_bricks(particle_key(key).cell, f.settings.cell_units[level], f.settings.support[level]);
    };
    GridLoop{}.each_together(f.counts->particle_cells, [&](std::uint32_t cell, bool exists) {
        ReachedBricks reached;
        std::uint32_t count = 0;
        if (exists) {
            reached = reached_by(cell);
            // Most cells reach what the one before does.
            if (cell == 0 || !(reached == reached_by(cell - 1))) count = reached.count();
        }
        Counter at = take_places(&f.counts->needed[static_cast<int>(Resource::reached_bricks)], count);
        if (count == 0 || at + count > room) return;
        Int3 b;
        for (b.z = reached.low.z; b.z <= reached.high.z; ++b.z)
            for (b.y = reached.low.y; b.y <= reached.high.y; ++b.y)
                for (b.x = reached.low.x; b.x <= reached.high.x; ++b.x) f.unsorted_reached_keys[at++] = brick_key(b);
    });
}

constexpr std::uint64_t no_brick = ~std::uint64_t{0};

/// The sorted keys that may name a brick.
__device__ std::uint64_t reached_key_count(const State& f) {
    const std::uint64_t listed = f.counts->needed[static_cast<int>(Resource::reached_bricks)];
    return listed < f.capacity[Resource::reached_bricks] ? listed : f.capacity[Resource::reached_bricks];
}

__device__ bool is_first_of_key(const State& f, std::uint32_t i) {
    return f.reached_keys[i] != no_brick && (i == 0 || f.reached_keys[i] != f.reached_keys[i - 1]);
}

__global__ void __launch_bounds__(block_threads) mark_first_keys(const __grid_constant__ State f) {
    GridLoop{}.each(reached_key_count(f), [&](std::uint32_t i) { f.first_of_key[i] = is_first_of_key(f, i) ? 1 : 0; });
}

__global__ void __launch_bounds__(block_threads) store_bricks(const __grid_constant__ State f) {
    const std::uint64_t keys = reached_key_count(f);
    GridLoop{}.each(keys, [&](std::uint32_t i) {
        const std::uint32_t brick = f.first_of_key[i];
        if (is_first_of_key(f, i) && brick < f.capacity[Resource::bricks]) {
            f.brick_keys[brick] = f.reached_keys[i];
            f.bricks[brick].coordinate = brick_coordinate(f.reached_keys[i]);
        }
    });
    if (blockIdx.x != 0 || threadIdx.x != 0) return;
    f.need(Resource::bricks, f.first_of_key[keys]);
    f.need(Resource::reached_bricks, f.counts->needed[static_cast<int>(Resource::reached_bricks)]);
}

/// Marks in shared memory, by many threads at once, in halves of words, which atomic operations are made for.
struct SharedMarks {
    unsigned* halves;
    __device__ std::uint64_t word(int w) const {
        return atomicOr(&halves[2 * w], 0U) | static_cast<std::uint64_t>(atomicOr(&halves[2 * w + 1], 0U)) << 32;
    }
    __device__ void add(int w, std::uint64_t cells) const {
        const auto low = static_cast<unsigned>(cells);
        const auto high = static_cast<unsigned>(cells >> 32);
        if (low != 0) atomicOr(&halves[2 * w], low);
        if (high != 0) atomicOr(&halves[2 * w + 1], high);
    }
};

/// Marks the base cells of a brick that a particle reaches; returns ReachedBox::count().
__device__ std::uint32_t mark_reached(const SharedMarks& marks, float x, float y, float z, float support) {
    const float reach = support + 16.0F;
    const ReachedBox box({x, y, z}, reach);
    if (box.empty()) return 0;
    // Most particles lie among others: rows that those have marked are passed over, four at a time.
    const std::uint64_t widest = row_bits(box.low[0], box.high[0]) * first_of_rows;
    for (int cz = box.low[2]; cz <= box.high[2]; ++cz) {
        const float gap_z = gap_to_cells(z, static_cast<float>(cz));
        for (int rows = box.low[1] & ~3; rows <= box.high[1]; rows += 4) {
            const int w = rows >> 2 | cz << 2;
            const std::uint64_t unmarked = widest & ~marks.word(w);
            if (unmarked == 0) continue;
            std::uint64_t reached = 0;
            for (int cy = max(box.low[1], rows); cy <= min(box.high[1], rows + 3); ++cy) {
                const int row = (cy & 3) << 4;
                if (unmarked >> row << 48 == 0) continue;
                const ReachedRows<float> cells(x, gap_to_cells(y, static_cast<float>(cy)), gap_z, reach);
                if (cells.set != 0)
                    reached |= row_bits(static_cast<int>(cells.first), static_cast<int>(cells.last)) << row;
            }
            marks.add(w, reached);
        }
    }
    return box.count();
}

/// A block of threads for every brick: its warps share the runs of particles near it.
__global__ void __launch_bounds__(block_threads, 2) mark_reached_cells(const __grid_constant__ State f) {
    __shared__ unsigned halves[2 * Brick::words];
    __shared__ Counter marked_in_brick;
    __shared__ std::uint32_t bricks;
    __shared__ bool goes_on;
    const SharedMarks marks{halves};
    // Another block may stop the frame meanwhile, which must not part the threads of this one.
    if (threadIdx.x == 0) bricks = f.count(Resource::bricks);
    __syncthreads();
    constexpr std::int64_t edge = std::int64_t{units_per_base_cell} * brick_size;
    const auto size = static_cast<float>(edge);
    LongLoop loop(f);
    for (std::uint32_t b = blockIdx.x; b < bricks; b += gridDim.x) {
        if (threadIdx.x < 2 * Brick::words) halves[threadIdx.x] = 0;
        if (threadIdx.x == 0) {
            marked_in_brick = 0;
            goes_on = loop.goes_on();
        }
        __syncthreads();
        if (!goes_on) return;
        Counter marked = 0;
        const Int3 at = f.bricks[b].coordinate;
        const Units3 origin{at.x * edge, at.y * edge, at.z * edge};
        unsigned run = 0;
        for (unsigned k = 0; k < particle_level_count; ++k) {
            const ParticleSetView set = f.set(k);
            if (set.cells.brick_count == 0) continue;
            NoBrickHints hints;
            set.for_each_run_near(
                origin, {{0.0F, 0.0F, 0.0F}, {size, size, size}}, hints,
                [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
                    if (run++ % block_warps != warp_in_block()) return;
                    for (std::uint32_t i = begin + lane_index(); i < end; i += warp_threads) {
                        const float4 p = f.particles[i];
                        marked +=
                            mark_reached(marks, p.x + shift[0], p.y + shift[1], p.z + shift[2],
                                         f.settings.has_own_supports ? Poly6{p.w, f.falls[i]}.support() : set.support);
                    }
                });
        }
        add_of_lanes(&marked_in_brick, marked);
        __syncthreads();
        if (threadIdx.x < Brick::words) {
            const int w = static_cast<int>(threadIdx.x);
            std::uint64_t cells = marks.word(w);
            if (f.settings.has_domain && cells != 0)
                cells &= word_in_domain(at, w, f.settings.domain_low, f.settings.domain_high);
            f.bricks[b].occupied[w] = cells;
        }
        __syncthreads();
        if (threadIdx.x != 0) continue;
        const std::uint32_t members = f.bricks[b].count();
        f.members_before[b] = members;
        atomicAdd(&f.counts->pairs, Counter{pairs_in_brick(marked_in_brick, members, f.settings.has_domain)});
    }
}

__global__ void __launch_bounds__(block_threads) number_members(const __grid_constant__ State f) {
    const std::uint32_t bricks = f.count(Resource::bricks);
    GridLoop{}.each(bricks, [&](std::uint32_t b) {
        f.bricks[b].first = static_cast<std::uint32_t>(f.members_before[b]);
        if (b == bricks - 1) f.need(Resource::blocks, f.members_before[bricks]);
    });
}

__global__ void __launch_bounds__(block_threads) find_neighbors(const __grid_constant__ State f) {
    const BrickGridView grid = f.grid();
    GridLoop{}.each(std::uint64_t{neighbor_slots} * grid.brick_count, [&](std::uint32_t i) {
        const std::uint32_t b = i / neighbor_slots;
        const int n = static_cast<int>(i % neighbor_slots);
        f.neighbors[b].brick[n] = grid.find(f.bricks[b].coordinate + neighbor_offset(n));
    });
}

/// One thread for every word of a brick.
__global__ void __launch_bounds__(block_threads) make_blocks(const __grid_constant__ State f) {
    GridLoop{}.each(std::uint64_t{Brick::words} * f.count(Resource::bricks), [&](std::uint32_t i) {
        const std::uint32_t b = i / Brick::words;
        const int w = static_cast<int>(i % Brick::words);
        const Brick& brick = f.bricks[b];
        std::uint32_t block = brick.first + brick.rank[w];
        for (std::uint64_t left = brick.occupied[w]; left != 0; left &= left - 1, ++block) {
            f.brick[block] = b;
            f.place[block] = static_cast<std::uint16_t>(64 * w + lowest_bit(left));
            f.level[block] = 0;
            f.wanted_points[block] = 0;
            f.corner_points[block] = 0;
            f.particle_counts[block] = 0;
        }
    });
}

/// Particles of level 0 in every stored base cell.
__global__ void __launch_bounds__(block_threads) count_particles(const __grid_constant__ State f) {
    const BrickGridView grid = f.grid();
    GridLoop{}.each(f.particle_count(), [&](std::uint32_t i) {
        if (key_level(f.keys[i]) != 0) return;
        const ParticleKey key = particle_key(f.keys[i]);
        const Units3 place = key_place(key, f.settings.cell_units[0]);
        const auto cell = [](std::int64_t p) { return static_cast<std::int32_t>(floor_div(p, units_per_base_cell)); };
        const Int3 at{cell(place.x), cell(place.y), cell(place.z)};
        const std::uint32_t brick = grid.find(brick_of(at));
        // Cells beyond the domain are not stored.
        if (brick != no_index && grid.bricks[brick].holds(index_in_brick(at)))
            atomicAdd(&f.particle_counts[grid.bricks[brick].number(index_in_brick(at))], 1U);
    });
}

void sort_particles(State& f, bool has_payload, const Launcher& launch) {
    const std::uint64_t n = f.capacity.particles;
    launch(n, block_threads, make_keys, f, has_payload);
    const SortKey* const sorted = has_payload ? sort_with_values(f.scratch_memory(), f.unsorted_keys, f.keys, f.sources,
                                                                 f.sources_room, n, launch.stream)
                                              : sort(f.scratch_memory(), f.unsorted_keys, f.keys, n, launch.stream);
    if (sorted != f.keys) std::swap(f.keys, f.unsorted_keys);
    launch(n, block_threads, mark_starts, f);
    exclusive_sum(f.scratch_memory(), f.starts, n, launch.stream);
    check(cudaMemsetAsync(f.particle_bricks, 0, f.capacity[Resource::particle_bricks] * sizeof(Brick), launch.stream),
          "cudaMemsetAsync");
    launch(n, block_threads, store_particles, f);
    launch(f.capacity[Resource::particle_bricks], block_threads, count_support_cells, f);
    if (f.settings.work_limit != 0.0) {
        const std::uint64_t probes = probe_count(n);
        launch(probes, block_threads, seed_probes, f);
        launch(probes, block_warps, count_neighbors, f);
        launch(1, block_threads, stop_if_sums_are_too_much, f);
    }
    launch(n, block_threads, measure_crowd, f);
    launch(1, block_threads, stop_if_crowded, f);
    if (!has_payload) return;
    launch(n, block_threads, order_by_payload, f);
    for (unsigned group = 0; group < f.attributes.groups(); ++group) launch(n, block_threads, store_numbers, f, group);
}

void store_reached_bricks(State& f, const Launcher& launch) {
    const std::uint64_t keys = f.capacity[Resource::reached_bricks];
    const std::uint64_t bricks = f.capacity[Resource::bricks];
    check(cudaMemsetAsync(f.unsorted_reached_keys, 0xFF, keys * sizeof(std::uint64_t), launch.stream),
          "cudaMemsetAsync");
    launch(f.capacity.particles, block_threads, list_reached_bricks, f);
    if (sort(f.scratch_memory(), f.unsorted_reached_keys, f.reached_keys, keys, launch.stream) != f.reached_keys)
        std::swap(f.reached_keys, f.unsorted_reached_keys);
    launch(keys, block_threads, mark_first_keys, f);
    exclusive_sum(f.scratch_memory(), f.first_of_key, keys + 1, launch.stream);
    launch(keys, block_threads, store_bricks, f);
    launch(bricks, 1, mark_reached_cells, f);
}

}  // namespace

void store_blocks(const State& state, const Launcher& launch) {
    const std::uint64_t bricks = state.capacity[Resource::bricks];
    exclusive_sum(state.scratch_memory(), state.members_before, bricks + 1, launch.stream);
    launch(bricks, block_threads, number_members, state);
    if (state.settings.work_limit != 0.0) launch(1, block_threads, stop_if_base_cells_are_too_much, state);
    launch(neighbor_slots * bricks, block_threads, find_neighbors, state);
    find_near_bricks(state, launch);
    launch(Brick::words * bricks, block_threads, make_blocks, state);
}

void register_particles(State& state, bool has_payload, const Launcher& launch) {
    sort_particles(state, has_payload, launch);
    if (state.settings.has_own_supports) fit_supports(state, launch);
    store_reached_bricks(state, launch);
    store_blocks(state, launch);
    if (state.settings.counts_particles) launch(state.capacity.particles, block_threads, count_particles, state);
    if (state.settings.divides_by_density) divide_weights_by_density(state, launch);
}

}  // namespace meniscus::cuda
