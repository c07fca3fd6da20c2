// Step 1 on the CPU: particles are sorted as keys and read back from them.
#include "steps/register_particles/register_particles.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>

#include "engine/cpu/words.hpp"
#include "engine/index_limit.hpp"
#include "particles/payload.hpp"
#include "particles/positions.hpp"
#include "steps/cpu_steps.hpp"
#include "steps/register_particles/crowd.hpp"
#include "steps/register_particles/work.hpp"

namespace meniscus::cpu {
namespace {

/// Calls write(particle's index in the frame, at) for the particles of a level, at = 0, 1, ...; resize(n) first.
template <class Resize, class Write>
void for_each_of_level(ParticleSets& sets, const ParticleFrame& frame, unsigned level, const Resize& resize,
                       const Write& write) {
    if (frame.levels.empty()) {
        const std::size_t count = level == 0 ? frame.count() : 0;
        resize(count);
        sets.workers.for_ranges(count, 8192, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t i = begin; i < end; ++i) write(i, i);
        });
        return;
    }
    const auto belongs = [&](std::size_t i) -> std::uint64_t { return frame.levels[i] == level ? 1 : 0; };
    resize(static_cast<std::size_t>(std::count(frame.levels.begin(), frame.levels.end(), level)));
    sets.scan.exclusive(sets.workers, frame.count(), belongs, [&](std::size_t i, std::uint64_t at) {
        if (belongs(i) != 0) write(i, at);
    });
}

/// Sorts keys alone: where only positions matter, particles of the same key are interchangeable.
void sort_keys(ParticleSets& sets, ParticleSet& set, const ParticleFrame& frame, unsigned level) {
    const PositionsView positions = positions_view(frame, sets.settings.units_per_length);
    for_each_of_level(
        sets, frame, level, [&](std::size_t n) { resize_for_overwrite(set.keys, n); },
        [&](std::size_t i, std::size_t at) { set.keys[at] = particle_key(positions.snapped(i), set.cell_units); });
    sets.workers.sort(set.keys.data(), set.keys.data() + set.keys.size(), std::less<>());
    set.sources.clear();
}

/// Sorts keys with the particles' indices, equal keys by their payload: the result does not depend on the order of the
/// frame.
void sort_identified_keys(ParticleSets& sets, ParticleSet& set, const ParticleFrame& frame, unsigned level) {
    const PositionsView positions = positions_view(frame, sets.settings.units_per_length);
    for_each_of_level(
        sets, frame, level, [&](std::size_t n) { resize_for_overwrite(set.identified, n); },
        [&](std::size_t i, std::size_t at) {
            set.identified[at] = {particle_key(positions.snapped(i), set.cell_units), static_cast<std::uint32_t>(i)};
        });
    const PayloadView payload = payload_view(frame);
    sets.workers.sort(set.identified.data(), set.identified.data() + set.identified.size(),
                      [&](const IdentifiedKey& a, const IdentifiedKey& b) {
                          if (a.key < b.key) return true;
                          return !(b.key < a.key) && payload.before(a.source, b.source);
                      });
    resize_for_overwrite(set.keys, set.identified.size());
    resize_for_overwrite(set.sources, set.identified.size());
    sets.workers.for_ranges(set.identified.size(), 8192, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            set.keys[i] = set.identified[i].key;
            set.sources[i] = set.identified[i].source;
        }
    });
}

/// Those of one level.
void sort_particles(ParticleSets& sets, const ParticleFrame& frame, unsigned level) {
    ParticleSet& set = sets[level];
    if (frame.arrays.empty())
        sort_keys(sets, set, frame, level);
    else
        sort_identified_keys(sets, set, frame, level);
    for (Array<float>* a : {&set.x, &set.y, &set.z, &set.weight}) {
        resize_for_overwrite(*a, set.count() + WideLanes::count);
        std::fill(a->end() - WideLanes::count, a->end(), 0.0F);
    }
    sets.workers.for_ranges(set.count(), 8192, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            key_position(set.keys[i], set.cell_units, set.x[i], set.y[i], set.z[i]);
            set.weight[i] = sets.settings.weight;
        }
    });
}

/// What vertices ask of the sorted particles of a level.
void store_values(ParticleSets& sets, ParticleSet& set, const ParticleFrame& frame, const AttributeNumbers& numbers) {
    const PayloadView payload = payload_view(frame);
    const std::size_t n = set.count();
    resize_for_overwrite(set.ranks, n + WideLanes::count);
    std::fill(set.ranks.end() - WideLanes::count, set.ranks.end(), 0.0F);
    resize_for_overwrite(set.values, n * numbers.shape.groups() * group_size_of_numbers);
    sets.workers.for_ranges(n, 8192, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            set.ranks[i] = AttributeNumber::as_float(static_cast<std::uint32_t>(i));
        for (unsigned g = 0; g < numbers.shape.groups(); ++g)
            for (unsigned k = 0; k < group_size_of_numbers; ++k) {
                float* const out = set.values.data() + g * group_size_of_numbers * n + k;
                const AttributeNumber number = numbers.group(g)[k];
                const bool exists = k < numbers.shape.count(g);
                for (std::size_t i = begin; i < end; ++i)
                    out[group_size_of_numbers * i] =
                        exists ? number.of_particle(payload.data[number.array], set.sources[i]) : 0.0F;
            }
    });
}

/// The support cells of a sorted set.
void store_support_cells(ParticleSets& sets, ParticleSet& set) {
    const auto& keys = set.keys;
    const auto starts_cell = [&](std::size_t i) -> std::uint64_t {
        return i == 0 || keys[i].cell != keys[i - 1].cell ? 1 : 0;
    };
    resize_for_overwrite(set.first, keys.size() + 1);
    resize_for_overwrite(set.cell_keys, keys.size());
    const std::uint64_t cells =
        sets.scan.exclusive(sets.workers, keys.size(), starts_cell, [&](std::size_t i, std::uint64_t at) {
            if (starts_cell(i) == 0) return;
            set.first[at] = static_cast<std::uint32_t>(i);
            set.cell_keys[at] = keys[i].cell;
        });
    set.first[cells] = static_cast<std::uint32_t>(keys.size());
    set.cell_keys.resize(cells);

    const auto starts_brick = [&](std::size_t i) {
        return i == 0 || set.cell_keys[i] >> brick_index_bits != set.cell_keys[i - 1] >> brick_index_bits;
    };
    set.cells.bricks.clear();
    set.cells.keys.clear();
    for (std::size_t i = 0; i < cells; ++i) {
        if (i % 65536 == 0) sets.workers.go_on();
        if (starts_brick(i)) {
            Brick& brick = set.cells.bricks.emplace_back();
            brick.coordinate = key_brick(set.cell_keys[i]);
            brick.clear();
            set.cells.keys.push_back(brick_key(brick.coordinate));
        }
        const int index = key_index(set.cell_keys[i]);
        set.cells.bricks.back().occupied[index >> 6] |= std::uint64_t{1} << (index & 63);
    }
    std::uint32_t members = 0;
    for (Brick& brick : set.cells.bricks) {
        brick.first = members;
        members += brick.count();
    }
    set.cells.members = members;
}

void require_uncrowded(const ParticleSets& sets, std::uint64_t particles) {
    std::uint64_t crowd = 0;
    for (const ParticleSet& set : sets.of_level)
        for (std::uint32_t cell = 0; cell < set.cells.members; ++cell) {
            const std::uint64_t in_cell = set.first[cell + 1] - set.first[cell];
            crowd += in_cell * in_cell;
        }
    if (is_crowded(crowd, particles, sets.settings)) throw_crowded(crowd, particles);
}

/// Of all levels together, in the order in which they are summed.
const ParticleKey& key_of(const ParticleSets& sets, std::uint64_t rank, unsigned& level) {
    for (level = 0; rank >= sets[level].count(); ++level) rank -= sets[level].count();
    return sets[level].keys[rank];
}

/// How many particles lie within their level's support of a particle's place, itself included.
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

/// The same for the sums at the base cells. pairs: of a base cell and a particle near it.
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

/// A slice of a brick at one z: its rows one after the other, four in a word.
constexpr int words_of_slice = Brick::words / brick_size;
static_assert(std::endian::native == std::endian::little);

/// Marks the base cells of a brick that a particle reaches, a slice at a time; returns ReachedBox::count().
std::uint32_t mark_reached(Brick& brick, float x, float y, float z, float support) {
    const float reach = support + 16.0F;
    const ReachedBox box({x, y, z}, reach);
    if (box.empty()) return 0;
    const std::uint64_t rows = row_bits(box.low[1], box.high[1]);
    std::uint64_t widest[words_of_slice];
    for (int w = 0; w < words_of_slice; ++w) {
        // Of four bits, each to the end of its row.
        const std::uint64_t four = rows >> (4 * w);
        const std::uint64_t starts = (four & 1) | (four & 2) << 15 | (four & 4) << 30 | (four & 8) << 45;
        widest[w] = starts * row_bits(box.low[0], box.high[0]);
    }
    WideLanes gap_y[brick_size / WideLanes::count];
    alignas(64) float row_numbers[brick_size];
    for (int i = 0; i < brick_size; ++i) row_numbers[i] = static_cast<float>(i);
    for (int r = 0; r < brick_size / WideLanes::count; ++r)
        gap_y[r] = gap_to_cells(y, WideLanes::load(row_numbers + r * WideLanes::count));
    for (int cz = box.low[2]; cz <= box.high[2]; ++cz) {
        std::uint64_t* const slice = brick.occupied + cz * words_of_slice;
        // Most particles lie among others, which have marked all this.
        std::uint64_t unmarked = 0;
        for (int w = 0; w < words_of_slice; ++w) unmarked |= widest[w] & ~slice[w];
        if (unmarked == 0) continue;
        const float gap_z = gap_to_cells(z, static_cast<float>(cz));
        std::uint16_t reached[brick_size] = {};
        for (int r = 0; r < brick_size / WideLanes::count; ++r) {
            const int first = r * WideLanes::count;
            const ReachedRows<WideLanes> cells(x, gap_y[r], gap_z, reach);
            add_spans(reached + first, cells.first, cells.last,
                      cells.set & static_cast<unsigned>(rows >> first) & ((1U << WideLanes::count) - 1));
        }
        std::uint64_t of_words[words_of_slice];
        std::memcpy(of_words, reached, sizeof of_words);
        for (int w = 0; w < words_of_slice; ++w) slice[w] |= of_words[w];
    }
    return box.count();
}

/// Fills `grid` with the base cells that a particle's support reaches; numbers stay to be given. Returns the pairs of a
/// base cell and a particle near it, about.
std::uint64_t mark_reached_cells(ParticleSets& sets, BrickGrid& grid) {
    // Every brick that a support cell's particles may reach, each once.
    constexpr std::int64_t edge = std::int64_t{units_per_base_cell} * brick_size;
    sets.reached_bricks.clear();
    for (const ParticleSet& set : sets.of_level) {
        ReachedBricks last;
        for (std::size_t i = 0; i < set.cell_keys.size(); ++i) {
            if (i % 1024 == 0) sets.workers.go_on();
            const ReachedBricks reached = reached_bricks(set.cell_keys[i], set.cell_units, set.support);
            if (i > 0 && reached == last) continue;
            last = reached;
            const auto& [low, high] = reached;
            Int3 c;
            for (c.z = low.z; c.z <= high.z; ++c.z)
                for (c.y = low.y; c.y <= high.y; ++c.y)
                    for (c.x = low.x; c.x <= high.x; ++c.x) sets.reached_bricks.push_back(brick_key(c));
        }
    }
    sets.workers.sort(sets.reached_bricks.data(), sets.reached_bricks.data() + sets.reached_bricks.size(),
                      std::less<>());
    sets.reached_bricks.erase(std::unique(sets.reached_bricks.begin(), sets.reached_bricks.end()),
                              sets.reached_bricks.end());

    resize_for_overwrite(grid.bricks, sets.reached_bricks.size());
    resize_for_overwrite(grid.keys, sets.reached_bricks.size());
    std::atomic<std::uint64_t> pairs{0};
    sets.workers.for_ranges(sets.reached_bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            Brick& brick = grid.bricks[i];
            grid.keys[i] = sets.reached_bricks[i];
            brick.coordinate = brick_coordinate(sets.reached_bricks[i]);
            brick.clear();
            const Units3 origin{brick.coordinate.x * edge, brick.coordinate.y * edge, brick.coordinate.z * edge};
            const auto size = static_cast<float>(edge);
            std::uint64_t marked = 0;
            for (const ParticleSet& set : sets.of_level) {
                // Coincident particles follow one another, and mark the same.
                float last[4] = {NAN, NAN, NAN, NAN};
                std::uint32_t by_last = 0;
                set.view().for_each_near(origin, {{0.0F, 0.0F, 0.0F}, {size, size, size}},
                                         [&, view = set.view()](float x, float y, float z, std::uint32_t particle) {
                                             if (particle % 16384 == 0) sets.workers.go_on();
                                             const float support = view.support_of(particle);
                                             if (x != last[0] || y != last[1] || z != last[2] || support != last[3])
                                                 by_last = mark_reached(brick, x, y, z, support);
                                             marked += by_last;
                                             last[0] = x;
                                             last[1] = y;
                                             last[2] = z;
                                             last[3] = support;
                                         });
            }
            const bool has_domain = sets.settings.has_domain;
            for (int w = 0; w < Brick::words && has_domain; ++w)
                brick.occupied[w] &=
                    word_in_domain(brick.coordinate, w, sets.settings.domain_low, sets.settings.domain_high);
            pairs.fetch_add(pairs_in_brick(marked, has_domain ? brick.count() : 0, has_domain),
                            std::memory_order_relaxed);
        }
    });
    return pairs.load(std::memory_order_relaxed);
}

/// Particles of level 0 in every stored base cell.
void count_particles(State& s, const ParticleSets& sets) {
    const BrickGrid& grid = s.grid;
    Array<std::uint32_t>& counts = s.particle_counts;
    resize_for_overwrite(counts, grid.members);
    const ParticleSet& set = sets[0];
    s.workers.for_ranges(grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            const Brick& brick = grid.bricks[i];
            const std::uint32_t last = i + 1 < grid.bricks.size() ? grid.bricks[i + 1].first : grid.members;
            std::fill(counts.begin() + brick.first, counts.begin() + last, 0U);
            constexpr std::int64_t edge = std::int64_t{units_per_base_cell} * brick_size;
            const Units3 origin{brick.coordinate.x * edge, brick.coordinate.y * edge, brick.coordinate.z * edge};
            const auto size = static_cast<float>(edge);
            // Wider than needed by the support; particles of other bricks are passed over.
            set.view().for_each_near(
                origin, {{0.0F, 0.0F, 0.0F}, {size, size, size}},
                [&](float x, float y, float z, std::uint32_t particle) {
                    if (particle % 16384 == 0) s.workers.go_on();
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

void store_blocks(State& s) {
    const std::size_t n = s.block_count();
    resize_for_overwrite(s.brick, n);
    resize_for_overwrite(s.place, n);
    resize_for_overwrite(s.level, n);
    resize_for_overwrite(s.sampled, n);
    resize_for_overwrite(s.inside, n);
    resize_for_overwrite(s.wanted_points, n);
    resize_for_overwrite(s.first_sample, n);
    resize_for_overwrite(s.edges, n);
    resize_for_overwrite(s.first_vertex, n);
    resize_for_overwrite(s.slots, n);
    // Passes do not write the words without a member.
    for (auto* set : {&s.any_inside, &s.all_inside, &s.chosen}) set->assign(s.grid.bricks.size() * Brick::words, 0);
    s.samples.clear();
    s.field_evaluations = 0;
    s.workers.for_ranges(s.grid.bricks.size(), 4, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = s.grid.bricks[b];
            std::uint32_t block = brick.first;
            for (int w = 0; w < Brick::words; ++w)
                for (std::uint64_t left = brick.occupied[w]; left != 0; left &= left - 1, ++block) {
                    s.brick[block] = static_cast<std::uint32_t>(b);
                    s.place[block] = static_cast<std::uint16_t>(64 * w + lowest_bit(left));
                    s.level[block] = 0;
                    s.sampled[block] = 0;
                    s.inside[block] = 0;
                    s.first_sample[block] = 0;
                }
        }
    });
}

void register_particles(State& s, ParticleSets& sets, NeighborSearch& near, const ParticleFrame& frame) {
    for (unsigned k = 0; k < particle_level_count; ++k) {
        sort_particles(sets, frame, k);
        if (s.attributes.shape.groups() != 0) store_values(sets, sets[k], frame, s.attributes);
        store_support_cells(sets, sets[k]);
    }
    const bool has_work_limit = s.settings.work_limit != 0.0;
    if (has_work_limit) require_bearable_sums(sets);
    require_uncrowded(sets, frame.count());
    near.forget();
    if (s.settings.has_own_supports) fit_supports(sets, near);
    const std::uint64_t pairs = mark_reached_cells(sets, s.grid);
    number_members(s.grid, s.workers);
    if (has_work_limit) require_bearable_base_cells(sets, pairs, s.grid.members);
    store_blocks(s);
    if (s.settings.counts_particles) count_particles(s, sets);
    if (s.settings.divides_by_density) divide_weights_by_density(sets, near);
}

}  // namespace meniscus::cpu
