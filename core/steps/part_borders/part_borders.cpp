// The borders of a part on the CPU.
#include "steps/part_borders/part_borders.hpp"

#include "engine/cpu/words.hpp"
#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {

void hash_borders(State& state) {
    const BlocksView blocks = state.blocks();
    const LatticePart& part = state.settings.part;
    state.border_hashes.assign(state.grid.bricks.size() * neighbor_slots, {});
    for_each_brick(state, [&](std::uint32_t brick) {
        for (int slot = 0; slot < neighbor_slots; ++slot) {
            if (!is_seam(part, state.grid.bricks[brick].coordinate, slot)) continue;
            WordHash& hash = state.border_hashes[std::size_t{brick} * neighbor_slots + static_cast<std::size_t>(slot)];
            const FacingCells cells(slot);
            for (int i = 0; i < cells.count(); ++i)
                add_cell_beside_seam(hash, blocks, state.raise_times.data(), brick, cells.place(i), slot);
        }
    });
}

void leave_other_bricks(State& state) {
    const LevelSets levels = state.level_sets();
    for_each_brick(state, [&](std::uint32_t brick) {
        if (state.settings.part.owns_brick(state.grid.bricks[brick].coordinate)) return;
        for (int level = 1; level <= 3; ++level)
            for (int w = 0; w < Brick::words; ++w) levels.at_least[level].word(brick, w) = 0;
    });
}

}  // namespace meniscus::cpu
