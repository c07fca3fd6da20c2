#include "stages/sample_field.hpp"

#include <algorithm>
#include <atomic>

#include "backends/cpu/clusters.hpp"
#include "backends/cpu/raise_levels.hpp"
#include "backends/cpu/surface.hpp"
#include "backends/numbering.hpp"
#include "field/lanes.hpp"

namespace meniscus::cpu {
namespace {

/// Which of a block's sampled points lie above the iso-value.
BlockMask points_above(BlockMask sampled, const float* samples, float iso) {
    BlockMask above = 0;
    if (sampled == ~BlockMask{0}) {
        for (int i = 0; i < 64; i += Lanes::count) above |= BlockMask{not_above(Lanes::load(samples + i), Lanes(iso))} << i;
        return ~above;
    }
    for (BlockMask left = sampled; left != 0; left &= left - 1) above |= BlockMask{*samples++ > iso} << lowest_bit(left);
    return above;
}

/// The values of a block's missing points among the known ones, in the order of the points.
void sample_missing_points(FieldSource& field, const Int3& at, BlockMask known, BlockMask missing, const float* known_samples, float* samples, unsigned worker) {
    alignas(32) float fresh[64];
    field.block_values(at, missing, fresh, worker);
    float by_bit[64];
    const float* next = fresh;
    for (BlockMask left = missing; left != 0; left &= left - 1) by_bit[lowest_bit(left)] = *next++;
    for (BlockMask left = known; left != 0; left &= left - 1) by_bit[lowest_bit(left)] = *known_samples++;
    for (BlockMask left = known | missing; left != 0; left &= left - 1) *samples++ = by_bit[lowest_bit(left)];
}

void sample_block(Surface& s, FieldSource& field, std::uint32_t block, const float* old_samples, unsigned worker) {
    const Int3 at = s.view().coordinate(block);
    const BlockMask known = s.sampled[block];
    const BlockMask missing = s.wanted_points[block] & ~known;
    const BlockMask sampled = known | missing;
    float* samples = s.samples.data() + s.first_sample[block];
    const auto lanes_for = [](BlockMask points) { return (popcount(points) + Lanes::count - 1) / Lanes::count; };
    if (sampled == ~BlockMask{0}) {
        field.block_values(at, sampled, samples, worker);
    } else if (lanes_for(sampled) == lanes_for(missing)) {
        // The known points' values come out a second time, to the same bits: cheaper than sorting them in.
        alignas(32) float values[64];
        field.block_values(at, sampled, values, worker);
        std::copy(values, values + popcount(sampled), samples);
    } else {
        sample_missing_points(field, at, known, missing, old_samples, samples, worker);
    }
    s.sampled[block] = sampled;
    s.inside[block] = points_above(sampled, samples, s.settings.iso);
    if (s.settings.has_domain) s.inside[block] &= domain_points(at, s.settings.domain_low, s.settings.domain_high);
}

/// The cells of a word for which condition(number) holds.
template <class Condition>
std::uint64_t cells_where(const Brick& brick, int w, std::uint64_t cells, const Condition& condition) {
    std::uint64_t result = 0;
    for_each_cell(brick, w, cells, [&](std::uint32_t block, int bit) { result |= std::uint64_t{condition(block)} << bit; });
    return result;
}

}  // namespace

bool grow_band(Surface& s) {
    const BlocksView blocks = s.view();
    const LevelSets levels = s.level_sets();
    const auto joining = [&](std::uint32_t brick, int w) {
        std::uint64_t cells = take_stale(s, StaleFor::band, brick, w) & ~levels.band(brick, w);
        if (cells != 0) cells &= levels.beside(1, brick, w);
        return cells_where(s.grid.bricks[brick], w, cells, [&](std::uint32_t block) { return joins_band(blocks, block); });
    };
    return raise_levels(s, joining, [&s](std::uint32_t block) { return s.wanted_level[block]; });
}

bool raise_at_slivers(Surface& s) {
    const BlocksView blocks = s.view();
    const LevelSets levels = s.level_sets();
    const auto missing = [&](std::uint32_t brick, int w) {
        const std::uint64_t cells = take_stale(s, StaleFor::slivers, brick, w) & cells_beside_finer(levels, brick, w);
        return cells_where(s.grid.bricks[brick], w, cells, [&](std::uint32_t block) { return misses_surface_on_face(blocks, block); });
    };
    return raise_levels(s, missing, [&s](std::uint32_t block) { return s.level[block] + 1; });
}

void sample_corner_points(Surface& s, FieldSource& field) {
    const BlocksView blocks = s.view();
    const LevelSets levels = s.level_sets();
    for_each_word(s, [&](std::uint32_t brick, int w) {
        std::uint64_t cells = take_stale(s, StaleFor::corner_points, brick, w);
        if (cells != 0) cells &= cells_with_corner_points(levels, brick, w);
        for_each_cell(s.grid.bricks[brick], w, cells, [&](std::uint32_t block, int) { s.wanted_points[block] = s.corner_points[block] = corner_points(blocks, block); });
    });
    sample_wanted_points(s, field);
}

void sample_wanted_points(Surface& s, FieldSource& field) {
    // A block that gains points moves to new room at the end of the samples; its old room stays unused until the next frame.
    const auto room = [&](std::size_t b) -> std::uint64_t {
        const BlockMask known = s.sampled[b];
        return (s.wanted_points[b] & ~known) == 0 ? 0 : static_cast<std::uint64_t>(popcount(s.wanted_points[b] | known));
    };
    std::atomic<std::uint64_t> evaluations{0};
    const std::size_t n = s.block_count();
    const std::size_t used = s.samples.size();
    const std::uint64_t added = s.scan.exclusive(s.workers, n, room, [&](std::size_t b, std::uint64_t before) {
        s.old_first_sample[b] = s.first_sample[b];
        if (room(b) != 0) s.first_sample[b] = static_cast<std::uint32_t>(used + before);
    });
    require_numbers(used + added, "the surface needs", "field samples");
    if (added == 0) return;
    if (s.samples.capacity() < used + added) s.samples.reserve(used + added + (used + added) / 4);
    s.samples.resize(used + added);
    s.workers.for_ranges(s.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        std::uint64_t here = 0;
        for (std::size_t brick = begin; brick < end; ++brick)
            for_each_clustered_member(s.grid.bricks[brick], [&](std::uint32_t b) {
                if (room(b) == 0) return;
                here += static_cast<std::uint64_t>(popcount(s.wanted_points[b] & ~s.sampled[b]));
                sample_block(s, field, b, s.samples.data() + s.old_first_sample[b], worker);
            });
        evaluations.fetch_add(here, std::memory_order_relaxed);
    });
    s.field_evaluations += evaluations.load(std::memory_order_relaxed);
}

void sample_field(Surface& s, FieldSource& field) {
    for (;;) {
        sample_corner_points(s, field);
        const bool grown = grow_band(s);
        const bool raised = raise_at_slivers(s);
        if (!grown && !raised) return;
        adjust_levels(s);
    }
}

void sample_edge_middles(Surface& s, FieldSource& field) {
    const BlocksView blocks = s.view();
    s.workers.for_ranges(s.block_count(), 1024, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b)
            s.wanted_points[b] = s.corner_points[b] == 0 || s.sampled[b] == ~BlockMask{0}
                                     ? 0 : edge_middles(blocks, static_cast<std::uint32_t>(b));
    });
    sample_wanted_points(s, field);
    s.workers.for_ranges(s.block_count(), 1024, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b)
            s.wanted_points[b] = (s.wanted_points[b] & level1_middles) == 0 ? 0 : half_edge_middles(blocks, static_cast<std::uint32_t>(b));
    });
    sample_wanted_points(s, field);
}

}  // namespace meniscus::cpu
