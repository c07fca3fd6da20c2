#include "stages/sample_field.hpp"

#include <atomic>
#include <string>

#include "backends/cpu/clusters.hpp"
#include "backends/cpu/level_sweep.hpp"
#include "backends/cpu/surface.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cpu {
namespace {

/// Values of some points of a block, then its array of samples with old and new ones in the order of the points.
void sample_block(Surface& s, FieldSource& field, std::uint32_t block, const float* old_samples, unsigned worker) {
    const BlocksView blocks = s.view();
    const Int3 at = blocks.coordinate(block);
    const BlockMask known = s.sampled[block];
    const BlockMask missing = s.wanted_points[block] & ~known;
    PointList points;
    for (BlockMask left = missing; left != 0; left &= left - 1) {
        const int bit = lowest_bit(left);
        points.add(static_cast<float>(point_coordinate(bit, 0) * units_per_cell),
                   static_cast<float>(point_coordinate(bit, 1) * units_per_cell),
                   static_cast<float>(point_coordinate(bit, 2) * units_per_cell));
    }
    alignas(32) float values[max_points];
    field.values(at, points, values, worker);
    const BlockMask allowed = s.settings.has_domain
                                  ? domain_points(at, s.settings.domain_low, s.settings.domain_high) : ~BlockMask{0};
    float* out = s.samples.data() + s.first_sample[block];
    const float* fresh = values;
    BlockMask inside = s.inside[block];
    for (BlockMask left = known | missing; left != 0; left &= left - 1) {
        const BlockMask bit = left & (~left + 1);
        if ((known & bit) != 0) {
            *out++ = *old_samples++;
        } else {
            if (*fresh > s.settings.iso && (allowed & bit) != 0) inside |= bit;
            *out++ = *fresh++;
        }
    }
    s.sampled[block] = known | missing;
    s.inside[block] = inside;
}

}  // namespace

bool grow_band(Surface& s) {
    return sweep_levels(s, band_rule, [&s](const BlocksView& blocks, std::uint32_t block) -> int {
        return blocks.level[block] == 0 && joins_band(blocks, block) ? s.wanted_level[block] : blocks.level[block];
    });
}

bool raise_at_slivers(Surface& s) {
    return sweep_levels(s, sliver_rule, [](const BlocksView& blocks, std::uint32_t block) {
        return blocks.level[block] + static_cast<int>(misses_surface_on_face(blocks, block));
    });
}

void sample_corner_points(Surface& s, FieldSource& field) {
    const BlocksView blocks = s.view();
    s.workers.for_ranges(s.block_count(), 4096, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b)
            if (take_stale(s, b, corner_rule)) s.wanted_points[b] = s.corner_points[b] = corner_points(blocks, static_cast<std::uint32_t>(b));
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
    if (used + added >= no_index)
        throw LimitExceeded("the surface needs more than " + std::to_string(no_index) +
                            " field samples, more than can be numbered: use a larger cell size or fewer particles");
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
    for (const int length : {4, 2}) {
        s.workers.for_ranges(s.block_count(), 1024, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t b = begin; b < end; ++b)
                s.wanted_points[b] = s.corner_points[b] == 0 ? 0 : edge_middles(blocks, static_cast<std::uint32_t>(b), length);
        });
        sample_wanted_points(s, field);
    }
}

}  // namespace meniscus::cpu
