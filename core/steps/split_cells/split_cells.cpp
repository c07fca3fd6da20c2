#include "steps/split_cells/split_cells.hpp"

#include "engine/cpu/split_cells.hpp"
#include "steps/adjust_levels/raise_levels.hpp"

namespace meniscus::cpu {

void find_band(Surface& s, const Array<CellReach>& reaches) {
    const BlocksView blocks = s.view();
    const BandTest test{s.settings.iso, s.settings.deep_inside};
    resize_for_overwrite(s.base_deep, s.grid.bricks.size() * Brick::words);
    const BaseVertexSets vertices{s.sign_sets().any_inside, {s.grid.view(), s.base_deep.data()}};
    // All words: those without a member are neighbors of others.
    s.workers.for_ranges(s.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b)
            for (int w = 0; w < Brick::words; ++w) {
                const auto brick = static_cast<std::uint32_t>(b);
                std::uint64_t inside = 0;
                std::uint64_t deep = 0;
                for_each_cell(s.grid.bricks[b], w, s.grid.bricks[b].occupied[w], [&](std::uint32_t block, int bit) {
                    inside |= (s.inside[block] & 1) << bit;
                    deep |= std::uint64_t{test.is_deep(blocks.value(block, 0))} << bit;
                });
                s.sign_sets().any_inside.word(brick, w) = s.sign_sets().all_inside.word(brick, w) = inside;
                vertices.deep.word(brick, w) = inside & deep;
            }
    });
    for_each_word(s, [&](std::uint32_t brick, int w) {
        const CornerSets corners(vertices, brick, w);
        for_each_cell(s.grid.bricks[brick], w, s.grid.bricks[brick].occupied[w], [&](std::uint32_t block, int bit) {
            s.level[block] = corners.may_hold_surface(bit, test, reaches[block].bound) ? 1 : 0;
        });
    });
}

int wanted_level(const SplitRule& rule, const BlocksView& blocks, std::uint32_t block) {
    return std::visit([&](const auto& level_of) { return level_of(blocks, block); }, rule);
}

void split_cells(Surface& s, const SplitRule& rule) {
    const BlocksView blocks = s.view();
    std::visit(
        [&](const auto& level_of) {
            s.workers.for_ranges(s.block_count(), 1024, [&](std::size_t begin, std::size_t end, unsigned) {
                for (std::size_t b = begin; b < end; ++b)
                    if (s.level[b] != 0)
                        s.level[b] = static_cast<std::uint8_t>(level_of(blocks, static_cast<std::uint32_t>(b)));
            });
        },
        rule);
    levels_are_new(s);
}

}  // namespace meniscus::cpu
