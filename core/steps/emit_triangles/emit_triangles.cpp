// Step 7 on the CPU.
#include "steps/emit_triangles/emit_triangles.hpp"

#include "engine/arrays.hpp"
#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {

void emit_triangles(State& state, Mesh& mesh) {
    const TriangleRange& last = mesh.levels.back();
    resize_for_overwrite(mesh.triangles, last.first + last.count);
    const BlocksView blocks = state.blocks();
    state.workers.for_ranges(state.mixed_cells.size(), 256, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            emit_cell_triangles(blocks, state.mixed_cells[i], cube_table.data(),
                                mesh.triangles.data() + state.slots[state.mixed_cells[i]].cells);
    });
}

}  // namespace meniscus::cpu
