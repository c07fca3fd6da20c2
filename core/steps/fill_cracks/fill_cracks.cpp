// Algorithm 3 on the CPU.
#include "steps/fill_cracks/fill_cracks.hpp"

#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {

void fill_cracks(State& state, Mesh& mesh) {
    const BlocksView blocks = state.blocks();
    state.workers.for_ranges(state.mixed_cells.size(), 256, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            if (state.is_cracked[i] != 0) {
                const std::uint32_t block = state.mixed_cells[i];
                emit_crack_triangles(blocks, block, ClosedCell(blocks, block), crack_table.data(),
                                     mesh.triangles.data() + state.slots[block].cracks);
            }
    });
}

}  // namespace meniscus::cpu
