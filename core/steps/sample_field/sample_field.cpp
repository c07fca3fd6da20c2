// Step 4 on the CPU: blocks are sampled in clusters, which share the particles near them.
#include "steps/sample_field/sample_field.hpp"

#include <algorithm>
#include <array>
#include <atomic>

#include "engine/index_limit.hpp"
#include "field/lanes.hpp"
#include "neighbors/cpu/clusters.hpp"
#include "steps/adjust_levels/raise_levels.hpp"
#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {
namespace {

/// Which of up to 64 values are inside the fluid: a bit for each, and any for others. values: has whole lanes to read.
std::uint64_t values_inside(const float* values, int count, float iso) {
    std::uint64_t outside = 0;
    for (int i = 0; i < count; i += WideLanes::count)
        outside |= std::uint64_t{less_equal(WideLanes::load(values + i), WideLanes(iso))} << i;
    return ~outside;
}

/// Writes a block's known samples and new ones in the order of their points; `out` may be where the known ones are.
void merge_samples(BlockMask known_points, const float* known, BlockMask new_points, const float* values, float* out) {
    const float* end[2] = {known + popcount(known_points), values + popcount(new_points)};
    out += popcount(known_points | new_points);
    for (BlockMask left = known_points | new_points; left != 0;) {
        const int bit = highest_bit(left);
        *--out = *--end[new_points >> bit & 1];
        left ^= BlockMask{1} << bit;
    }
}

/// The same for another room, beyond which whole lanes may be overwritten.
void move_samples(BlockMask known_points, const float* known, BlockMask new_points, const float* values, float* room) {
    constexpr BlockMask base_vertex = 1;
    if (known_points != base_vertex) return merge_samples(known_points, known, new_points, values, room);
    *room++ = *known;
    for (int i = 0; i < popcount(new_points); i += WideLanes::count) WideLanes::load(values + i).store(room + i);
}

/// Enters points of a block whose samples are written. inside: those of them that are above the iso-value.
void enter_points(State& state, std::uint32_t block, BlockMask points, BlockMask inside) {
    if (state.settings.has_domain)
        inside &=
            domain_points(state.blocks().coordinate(block), state.settings.domain_low, state.settings.domain_high);
    const BlockMask sampled = state.sampled[block] | points;
    const BlockMask all_inside = state.inside[block] | inside;
    state.sampled[block] = sampled;
    state.inside[block] = all_inside;
    state.sign_sets().any_inside.put(state.brick[block], state.place[block], all_inside != 0);
    state.sign_sets().all_inside.put(state.brick[block], state.place[block], all_inside == sampled);
}

BlockMask missing_points(const State& state, std::uint32_t block) {
    return state.wanted_points[block] & ~state.sampled[block];
}

/// The missing middles of level-1 edges: each is followed by the middle of one of its halves.
BlockMask followed_points(Wanted wanted, BlockMask missing) {
    return wanted == Wanted::middles ? missing & level1_middles : 0;
}

/// Samples the chosen blocks of a cluster, whose samples move to `room` one after the other, those of whole blocks
/// first; returns the number of new points.
std::uint64_t sample_cluster(State& state, FieldSource& field, Wanted wanted, const Brick& brick, const Int3& corner,
                             const std::uint64_t* chosen, std::uint64_t& room, unsigned worker) {
    const Int3 lowest = brick.corner() + corner;
    std::uint32_t block[cluster_blocks];
    ClusterValues values;
    ClusterPoints missing{};
    ClusterPoints asked{};
    ClusterPoints followed{};
    std::uint64_t evaluations = 0;
    for (std::size_t i = 0; i < cluster_blocks; ++i) {
        const int place = index_in_brick(corner + cluster_step(static_cast<int>(i)));
        if ((chosen[place >> 6] >> (place & 63) & 1) == 0) continue;
        block[i] = brick.number(place);
        asked[i] = missing[i] = missing_points(state, block[i]);
        followed[i] = followed_points(wanted, missing[i]);
        evaluations += static_cast<std::uint64_t>(popcount(missing[i]));
        if ((state.sampled[block[i]] | missing[i]) != ~BlockMask{0}) continue;
        // A block that becomes whole is sampled as a whole, right into its room.
        asked[i] = ~BlockMask{0};
        values.of[i] = state.samples.data() + room;
        state.first_sample[block[i]] = static_cast<std::uint32_t>(room);
        room += 64;
    }
    field.cluster_values(lowest, asked, values, worker);
    const auto inside = [&](std::size_t i, BlockMask points) {
        return scatter_bits(values_inside(values.of[i], popcount(points), state.settings.iso), points);
    };
    bool any_followed = false;
    for (std::size_t i = 0; i < cluster_blocks; ++i) {
        if (missing[i] == 0) continue;
        if (asked[i] != ~BlockMask{0}) {
            const BlockMask known = state.sampled[block[i]];
            move_samples(known, state.samples.data() + state.first_sample[block[i]], missing[i], values.of[i],
                         state.samples.data() + room);
            state.first_sample[block[i]] = static_cast<std::uint32_t>(room);
            room += static_cast<std::uint64_t>(popcount(known | missing[i]) + popcount(followed[i]));
        }
        enter_points(state, block[i], missing[i], inside(i, asked[i]));
        if (followed[i] == 0) continue;
        followed[i] = half_edge_middles(state.inside[block[i]], followed[i]) & ~state.sampled[block[i]];
        any_followed = true;
    }
    if (!any_followed) return evaluations;
    field.cluster_values(lowest, followed, values, worker);
    for (std::size_t i = 0; i < cluster_blocks; ++i) {
        if (followed[i] == 0) continue;
        evaluations += static_cast<std::uint64_t>(popcount(followed[i]));
        float* const samples = state.samples.data() + state.first_sample[block[i]];
        merge_samples(state.sampled[block[i]], samples, followed[i], values.of[i], samples);
        enter_points(state, block[i], followed[i], inside(i, followed[i]));
    }
    return evaluations;
}

/// Chooses those cells of a word that miss points of wanted(block, bit), and notes the wanted points.
template <class WantedPoints>
void choose_blocks(State& state, std::uint32_t brick, int w, std::uint64_t cells, const WantedPoints& wanted) {
    std::uint64_t chosen = 0;
    for_each_cell(state.grid.bricks[brick], w, cells, [&](std::uint32_t block, int bit) {
        state.wanted_points[block] = wanted(block, bit);
        chosen |= std::uint64_t{missing_points(state, block) != 0} << bit;
    });
    state.chosen_cells().word(brick, w) = chosen;
}

/// The cells of a word for which condition(number) holds.
template <class Condition>
std::uint64_t cells_where(const Brick& brick, int w, std::uint64_t cells, const Condition& condition) {
    std::uint64_t result = 0;
    for_each_cell(brick, w, cells,
                  [&](std::uint32_t block, int bit) { result |= std::uint64_t{condition(block)} << bit; });
    return result;
}

}  // namespace

void sample_wanted_points(State& state, FieldSource& field, Wanted wanted) {
    const CellSetView chosen = state.chosen_cells();
    resize_for_overwrite(state.brick_counts, state.grid.bricks.size());
    for_each_brick(state, [&](std::uint32_t b) {
        std::uint64_t room = 0;
        const Brick& brick = state.grid.bricks[b];
        for_each_word(brick, [&](int w) {
            for_each_cell(brick, w, chosen.word(b, w), [&](std::uint32_t block, int) {
                const BlockMask missing = missing_points(state, block);
                room += static_cast<std::uint64_t>(popcount(state.sampled[block] | missing) +
                                                   popcount(followed_points(wanted, missing)));
            });
        });
        // Whole lanes are written at the end, too.
        state.brick_counts[b] = room == 0 ? 0 : room + WideLanes::count;
    });
    // A block that gains points moves to new room at the end of the samples; its old room stays unused until the next
    // frame.
    const std::uint64_t added = counts_to_starts(state.brick_counts);
    const std::size_t used = state.samples.size();
    require_indexable(used + added, "the surface needs", "field samples");
    if (added == 0) return;
    if (state.samples.capacity() < used + added) state.samples.reserve(used + added + (used + added) / 4);
    state.samples.resize(used + added);
    std::atomic<std::uint64_t> evaluations{0};
    state.workers.for_ranges(state.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        std::uint64_t here = 0;
        for (std::size_t b = begin; b < end; ++b) {
            const std::uint64_t* const cells = &chosen.word(static_cast<std::uint32_t>(b), 0);
            std::uint64_t room = used + state.brick_counts[b];
            for_each_cluster(cells, [&](const Int3& corner) {
                here += sample_cluster(state, field, wanted, state.grid.bricks[b], corner, cells, room, worker);
            });
        }
        evaluations.fetch_add(here, std::memory_order_relaxed);
    });
    state.field_evaluations += evaluations.load(std::memory_order_relaxed);
}

namespace {

/// Whether the sampled points on a cell's closed box show both signs. Where no block is stored, all are outside.
bool sees_both(const BlocksView& blocks, std::uint32_t block) {
    const ClosedCell cell(blocks, block);
    bool any_inside = false, any_outside = false;
    for (int i = 0; i < 8; ++i) {
        BlockMask points = ~BlockMask{0};
        for (int axis = 0; axis < 3; ++axis)
            if ((i >> axis & 1) != 0) points &= low_face(axis);
        if (cell.block[i] == no_index) {
            any_outside = true;
            continue;
        }
        const BlockMask inside = blocks.inside[cell.block[i]] & points;
        any_inside |= inside != 0;
        any_outside |= inside != (blocks.sampled[cell.block[i]] & points);
    }
    return any_inside && any_outside;
}

/// Takes the cells into the band that a neighbor's samples show to hold surface; returns whether there were any.
bool grow_band(State& state, const WantedLevel& wanted_level) {
    const BlocksView blocks = state.blocks();
    const LevelSets levels = state.level_sets();
    const SignSets signs = state.sign_sets();
    const auto joining = [&](std::uint32_t brick, int w) {
        std::uint64_t cells = take_stale(state, StaleFor::band, brick, w) & ~levels.band(brick, w);
        if (cells != 0)
            cells &= levels.beside(1, brick, w) & signs.cells_seeing_both(brick, w) &
                     state.settings.part.settling_word(state.grid.bricks[brick].coordinate, w);
        return cells_where(state.grid.bricks[brick], w, cells, [&](std::uint32_t block) {
            return sees_both(blocks, block) && holds_at_a_face(joins_band, blocks, block);
        });
    };
    return raise_levels(state, joining, wanted_level);
}

/// Raises the cells by one level that would cut off a finer neighbor's surface in a sliver; returns whether there were
/// any. band_has_grown: the cells that have joined are not sampled yet, so that all must be looked at once more.
bool raise_at_slivers(State& state, bool band_has_grown) {
    const BlocksView blocks = state.blocks();
    const LevelSets levels = state.level_sets();
    const SignSets signs = state.sign_sets();
    const auto missing = [&](std::uint32_t brick, int w) {
        std::uint64_t cells = band_has_grown ? state.stale_cells(StaleFor::slivers).word(brick, w)
                                             : take_stale(state, StaleFor::slivers, brick, w);
        if (cells != 0) cells &= cells_beside_finer(levels, brick, w);
        if (cells != 0) cells &= signs.cells_seeing_both(brick, w);
        return cells_where(state.grid.bricks[brick], w, cells,
                           [&](std::uint32_t block) { return holds_at_a_face(misses_surface, blocks, block); });
    };
    return raise_levels(state, missing, [&state](std::uint32_t block) { return state.level[block] + 1; });
}

/// Samples the corner points of the cells whose surroundings have changed.
void sample_corner_points(State& state, FieldSource& field) {
    const LevelSets levels = state.level_sets();
    for_each_word(state, [&](std::uint32_t brick, int w) {
        state.chosen_cells().word(brick, w) = 0;
        const std::uint64_t stale = take_stale(state, StaleFor::corner_points, brick, w);
        if (stale == 0) return;
        const LevelSetsAround around(levels, brick, w);
        choose_blocks(state, brick, w, stale & around.with_corner_points(),
                      [&](std::uint32_t, int bit) { return corner_points(around(bit)); });
    });
    sample_wanted_points(state, field, Wanted::corners);
}

}  // namespace

void sample_field(State& state, FieldSource& field, const WantedLevel& wanted_level, Slivers slivers) {
    for (;;) {
        sample_corner_points(state, field);
        ++state.now.round;
        state.now.step = SettlingTime::joining;
        const bool grown = grow_band(state, wanted_level);
        state.now.step = SettlingTime::slivers;
        const bool raised = slivers == Slivers::raised && raise_at_slivers(state, grown);
        if (!grown && !raised) return;
        adjust_levels(state);
    }
}

void sample_edge_middles(State& state, FieldSource& field) {
    const BlocksView blocks = state.blocks();
    const LevelSets levels = state.level_sets();
    const SignSets signs = state.sign_sets();
    for_each_word(state, [&](std::uint32_t brick, int w) {
        const LevelSetsAround around(levels, brick, w);
        choose_blocks(
            state, brick, w,
            around.with_corner_points() & signs.blocks_seeing_both(brick, w) & state.grid.bricks[brick].occupied[w],
            [&](std::uint32_t block, int bit) {
                return state.sampled[block] == ~BlockMask{0} ? 0 : edge_middles(blocks, block, around(bit));
            });
    });
    sample_wanted_points(state, field, Wanted::middles);
}

}  // namespace meniscus::cpu
