// Step 1 on the CPU.
#include "steps/register_particles/register_particles.hpp"

#include <algorithm>
#include <atomic>

#include "engine/index_limit.hpp"
#include "steps/cpu_steps.hpp"
#include "steps/register_particles/crowd.hpp"
#include "steps/register_particles/work.hpp"

namespace meniscus::cpu {
namespace {

void require_uncrowded(const ParticleSets& sets, std::uint64_t particles) {
    std::uint64_t crowd = 0;
    for (const ParticleSet& set : sets.of_level)
        for (std::uint32_t cell = 0; cell < set.cells.members; ++cell) {
            const std::uint64_t in_cell = set.first[cell + 1] - set.first[cell];
            crowd += in_cell * in_cell;
        }
    if (is_crowded(crowd, particles, sets.settings)) throw_crowded(crowd, particles);
}

/// The key of a particle by its rank in all levels together, in the order in which they are summed.
const ParticleKey& key_of(const ParticleSets& sets, std::uint64_t rank, unsigned& level) {
    for (level = 0; rank >= sets[level].count(); ++level) rank -= sets[level].count();
    return sets[level].keys[rank];
}

/// The number of particles within their level's support of a particle's place, itself included.
std::uint64_t count_neighbors(const ParticleSets& sets, std::uint64_t rank) {
    unsigned level = 0;
    const ParticleKey& key = key_of(sets, rank, level);
    const Units3 place = place_in_cell(key);
    const float px = static_cast<float>(place.x), py = static_cast<float>(place.y), pz = static_cast<float>(place.z);
    std::uint64_t neighbors = 0;
    for (const ParticleSet& of_level : sets.of_level) {
        if (of_level.count() == 0) continue;
        const ParticleSetView set = of_level.view();
        BrickHints hints;
        set.for_each_run_near(cell_corner(key.cell, sets[level].cell_units), {{px, py, pz}, {px, py, pz}}, hints,
                              [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
                                  sets.workers.go_on();
                                  std::uint32_t near = 0;
                                  for (std::uint32_t i = begin; i < end; ++i)
                                      near += is_neighbor(set.x[i] + shift[0] - px, set.y[i] + shift[1] - py,
                                                          set.z[i] + shift[2] - pz, set.support);
                                  neighbors += near;
                              });
    }
    return neighbors;
}

/// Refuses a frame for the work of its particles' sums over each other, before it is done.
void require_bearable_sums(const ParticleSets& sets) {
    std::uint64_t particles = 0;
    for (const ParticleSet& set : sets.of_level) particles += set.count();
    const std::uint32_t probes = probe_count(particles);
    if (probes == 0) return;
    std::uint64_t seed = 0;
    for (std::uint32_t i = 0; i < probes; ++i) {
        unsigned level = 0;
        seed += key_bits(key_of(sets, std::uint64_t{i} * particles_per_probe, level));
    }
    const double even =
        even_work<EvenNeighbors>(sets.settings, particles, [&](unsigned k) { return sets[k].count() != 0; });
    const double most = most_work(sets.settings, even);
    std::atomic<std::uint64_t> neighbors{0};
    const auto work = [&] { return work_at_particles(neighbors.load(std::memory_order_relaxed), particles); };
    sets.workers.for_ranges(probes, 4, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end && work() <= most; ++i)
            neighbors.fetch_add(count_neighbors(sets, probed_particle(static_cast<std::uint32_t>(i), seed, particles)),
                                std::memory_order_relaxed);
    });
    if (work() > most) throw_too_much_work("the particles' places", work(), even, sets.settings);
}

/// The same for the sums at the base cells. pairs: number of pairs of a base cell and a particle near it.
void require_bearable_base_cells(const ParticleSets& sets, std::uint64_t pairs, std::uint32_t base_cells) {
    double even_cells = 0.0;
    for (unsigned k = 0; k < particle_level_count; ++k)
        even_cells += even_base_cells(sets.settings, k, sets[k].count());
    if (base_cells > most_base_cells(sets.settings, even_cells))
        throw_too_many_base_cells(base_cells, even_cells, sets.settings);
    const double even =
        even_work<EvenNearBaseCell>(sets.settings, base_cells, [&](unsigned k) { return sets[k].count() != 0; });
    if (static_cast<double>(pairs) > most_work(sets.settings, even))
        throw_too_much_work("the base cells", static_cast<double>(pairs), even, sets.settings);
}

/// Counts the particles of level 0 in every stored base cell.
void count_particles(State& state, const ParticleSets& sets) {
    const BrickGrid& grid = state.grid;
    Array<std::uint32_t>& counts = state.particle_counts;
    resize_for_overwrite(counts, grid.members);
    const ParticleSet& set = sets[0];
    state.workers.for_ranges(grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            const Brick& brick = grid.bricks[i];
            const std::uint32_t last = i + 1 < grid.bricks.size() ? grid.bricks[i + 1].first : grid.members;
            std::fill(counts.begin() + brick.first, counts.begin() + last, 0U);
            constexpr std::int64_t edge = std::int64_t{units_per_base_cell} * brick_size;
            const Units3 origin{brick.coordinate.x * edge, brick.coordinate.y * edge, brick.coordinate.z * edge};
            const auto size = static_cast<float>(edge);
            // The search is wider than needed by the support; particles of other bricks are passed over.
            set.view().for_each_near(
                origin, {{0.0F, 0.0F, 0.0F}, {size, size, size}},
                [&](float x, float y, float z, std::uint32_t particle) {
                    if (particle % 16384 == 0) state.workers.go_on();
                    if (x < 0.0F || y < 0.0F || z < 0.0F || x >= size || y >= size || z >= size) return;
                    constexpr float cell = units_per_base_cell;
                    const Int3 at{static_cast<int>(x / cell), static_cast<int>(y / cell), static_cast<int>(z / cell)};
                    // Cells beyond the domain are not stored.
                    if (brick.holds(index_in_brick(at))) ++counts[brick.number(index_in_brick(at))];
                });
        }
    });
}

}  // namespace

void number_members(BrickGrid& grid, Workers& workers) {
    std::uint64_t total = 0;
    for (Brick& b : grid.bricks) {
        b.first = static_cast<std::uint32_t>(total);
        total += b.count();
        require_indexable(total, "the frame reaches", "base cells");
    }
    grid.members = static_cast<std::uint32_t>(total);
    resize_for_overwrite(grid.neighbors, grid.bricks.size());
    const BrickGridView view = grid.view();
    workers.for_ranges(grid.bricks.size(), 64, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) {
            const Int3 at = grid.bricks[b].coordinate;
            for (int i = 0; i < neighbor_slots; ++i) grid.neighbors[b].brick[i] = view.find(at + neighbor_offset(i));
        }
    });
}

void store_blocks(State& state) {
    const std::size_t n = state.block_count();
    resize_for_overwrite(state.brick, n);
    resize_for_overwrite(state.place, n);
    resize_for_overwrite(state.level, n);
    resize_for_overwrite(state.sampled, n);
    resize_for_overwrite(state.inside, n);
    resize_for_overwrite(state.wanted_points, n);
    resize_for_overwrite(state.first_sample, n);
    resize_for_overwrite(state.edges, n);
    resize_for_overwrite(state.first_vertex, n);
    resize_for_overwrite(state.slots, n);
    // Passes do not write the words without a member.
    for (auto* set : {&state.any_inside, &state.all_inside, &state.chosen})
        set->assign(state.grid.bricks.size() * Brick::words, 0);
    state.samples.clear();
    state.raise_times.assign(state.settings.part.is_whole ? 0 : n, {});
    state.now = {};
    state.field_evaluations = 0;
    state.workers.for_ranges(state.grid.bricks.size(), 4, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = state.grid.bricks[b];
            std::uint32_t block = brick.first;
            for (int w = 0; w < Brick::words; ++w)
                for (std::uint64_t left = brick.occupied[w]; left != 0; left &= left - 1, ++block) {
                    state.brick[block] = static_cast<std::uint32_t>(b);
                    state.place[block] = static_cast<std::uint16_t>(64 * w + lowest_bit(left));
                    state.level[block] = 0;
                    state.sampled[block] = 0;
                    state.inside[block] = 0;
                    state.first_sample[block] = 0;
                }
        }
    });
}

void register_particles(State& state, ParticleSets& sets, NeighborSearch& search, const ParticleFrame& frame) {
    sort_particles(sets, frame, state.attributes);
    const bool has_work_limit = state.settings.work_limit != 0.0;
    if (has_work_limit) require_bearable_sums(sets);
    require_uncrowded(sets, frame.count());
    search.forget();
    if (state.settings.has_own_supports) fit_supports(sets, search);
    const std::uint64_t pairs = mark_reached_cells(sets, state.grid);
    number_members(state.grid, state.workers);
    if (has_work_limit) require_bearable_base_cells(sets, pairs, state.grid.members);
    store_blocks(state);
    if (state.settings.counts_particles) count_particles(state, sets);
    if (state.settings.divides_by_density) divide_weights_by_density(sets, search);
}

}  // namespace meniscus::cpu
