#include "stages/split_cells.hpp"

#include <algorithm>

#include "backends/cpu/split_cells.hpp"

namespace meniscus::cpu {

void find_band(Surface& s, const Array<CellReach>& reaches) {
    const BlocksView blocks = s.view();
    const BandTest test{s.settings.iso, s.settings.deep_inside};
    s.workers.for_ranges(s.block_count(), 1024, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) {
            const auto block = static_cast<std::uint32_t>(b);
            const ClosedCell cell(blocks, block);
            int inside_corners = 0;
            float smallest = blocks.value(block, 0);
            for (const std::uint32_t corner : cell.block) {
                inside_corners += static_cast<int>(blocks.inside_or_none(corner) & 1);
                smallest = std::min(smallest, corner == no_index ? 0.0F : blocks.value(corner, 0));
            }
            s.level[b] = test.may_hold_surface(inside_corners, smallest, reaches[b].bound) ? 1 : 0;
        }
    });
}

void split_cells(Surface& s, const SplitCriterion& criterion) {
    const BlocksView blocks = s.view();
    std::visit(
        [&](const auto& level_of) {
            s.workers.for_ranges(s.block_count(), 1024, [&](std::size_t begin, std::size_t end, unsigned) {
                for (std::size_t b = begin; b < end; ++b) {
                    s.wanted_level[b] = static_cast<std::uint8_t>(level_of(blocks, static_cast<std::uint32_t>(b)));
                    if (s.level[b] != 0) s.level[b] = s.wanted_level[b];
                }
            });
        },
        criterion);
    levels_are_new(s);
}

}  // namespace meniscus::cpu
