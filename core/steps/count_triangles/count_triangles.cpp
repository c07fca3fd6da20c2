// Step 5 on the CPU, and the order of the mesh.
#include "steps/count_triangles/count_triangles.hpp"

#include <algorithm>

#include "engine/cpu/words.hpp"
#include "engine/index_limit.hpp"
#include "steps/cpu_steps.hpp"
#include "steps/fill_cracks/fill_cracks.hpp"

namespace meniscus::cpu {
namespace {

constexpr std::size_t crack_level = static_cast<std::size_t>(TriangleLevel::crack);

/// Lists them brick by brick, and leaves in brick_counts the number of those before each brick.
void list_mixed_cells(State& state) {
    const LevelSets levels = state.level_sets();
    const SignSets signs = state.sign_sets();
    const CellSetView mixed = state.chosen_cells();
    resize_for_overwrite(state.brick_counts, state.grid.bricks.size());
    for_each_brick(state, [&](std::uint32_t brick) {
        std::uint64_t count = 0;
        for_each_word(state.grid.bricks[brick], [&](int w) {
            const std::uint64_t band = levels.band(brick, w);
            mixed.word(brick, w) = band == 0 ? 0 : band & signs.cells_seeing_both(brick, w);
            count += static_cast<std::uint64_t>(popcount(mixed.word(brick, w)));
        });
        state.brick_counts[brick] = count;
    });
    resize_for_overwrite(state.mixed_cells, counts_to_starts(state.brick_counts));
    for_each_brick(state, [&](std::uint32_t brick) {
        std::uint64_t at = state.brick_counts[brick];
        for_each_word(state.grid.bricks[brick], [&](int w) {
            for_each_cell(state.grid.bricks[brick], w, mixed.word(brick, w),
                          [&](std::uint32_t block, int) { state.mixed_cells[at++] = block; });
        });
    });
}

/// The mesh's order: by level, by brick within a level, by base cell within a brick.
void order_by_level_and_brick(State& state, Mesh& mesh) {
    const std::size_t bricks = state.grid.bricks.size();
    resize_for_overwrite(state.brick_triangles, bricks);
    const auto each_block = [&](std::size_t brick, const auto& visit) {
        const std::uint64_t end = brick + 1 < bricks ? state.brick_counts[brick + 1] : state.mixed_cells.size();
        for (std::uint64_t i = state.brick_counts[brick]; i < end; ++i)
            visit(state.slots[state.mixed_cells[i]], state.level[state.mixed_cells[i]] - 1U);
    };
    state.workers.for_ranges(bricks, 4, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) {
            state.brick_triangles[b] = {};
            each_block(b, [&](const TriangleSlots& slots, std::size_t level) {
                state.brick_triangles[b][level] += slots.cells;
                state.brick_triangles[b][crack_level] += slots.cracks;
            });
        }
    });
    std::uint64_t total = 0;
    for (std::size_t level = 0; level < triangle_level_count; ++level) {
        mesh.levels[level].first = static_cast<std::uint32_t>(total);
        for (auto& triangles : state.brick_triangles) {
            const std::uint32_t own = triangles[level];
            triangles[level] = static_cast<std::uint32_t>(total);
            total += own;
        }
        require_indexable(total, "the surface has", "triangles");
        mesh.levels[level].count = static_cast<std::uint32_t>(total) - mesh.levels[level].first;
    }
    state.workers.for_ranges(bricks, 4, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) {
            auto next = state.brick_triangles[b];
            each_block(b, [&](TriangleSlots& slots, std::size_t level) {
                const TriangleSlots counts = slots;
                slots = {next[level], next[crack_level]};
                next[level] += counts.cells;
                next[crack_level] += counts.cracks;
            });
        }
    });
    mesh.bricks.clear();
    for (std::size_t b = 0; b < bricks; ++b) {
        MeshBrick brick;
        const Int3 at = state.grid.bricks[b].coordinate;
        brick.coordinate = {at.x, at.y, at.z};
        for (std::size_t level = 0; level < triangle_level_count; ++level) {
            const std::uint32_t end = b + 1 < bricks ? state.brick_triangles[b + 1][level]
                                                     : mesh.levels[level].first + mesh.levels[level].count;
            brick.ranges[level] = {state.brick_triangles[b][level], end - state.brick_triangles[b][level]};
        }
        if (brick.triangle_count() != 0) mesh.bricks.push_back(brick);
    }
}

}  // namespace

std::array<std::uint64_t, 3> count_band_cells(State& state) {
    std::array<std::uint64_t, 4> of_at_least{};
    for (std::size_t level = 1; level <= 3; ++level)
        for (const std::uint64_t cells : state.at_least[level])
            of_at_least[level] += static_cast<std::uint64_t>(popcount(cells));
    return {of_at_least[1] - of_at_least[2], of_at_least[2] - of_at_least[3], of_at_least[3]};
}

void count_triangles(State& state, Mesh& mesh) {
    list_mixed_cells(state);
    resize_for_overwrite(state.is_cracked, state.mixed_cells.size());
    // Beside a part's own cells lie others.
    const bool one_level = state.settings.part.is_whole &&
                           std::all_of(state.mixed_cells.begin(), state.mixed_cells.end(), [&](std::uint32_t b) {
                               return state.level[b] == state.level[state.mixed_cells[0]];
                           });
    const BlocksView blocks = state.blocks();
    state.workers.for_ranges(state.mixed_cells.size(), 256, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t block = state.mixed_cells[i];
            state.slots[block] = {count_cell_triangles(blocks, block, cube_table.data()),
                                  one_level ? 0 : count_crack_triangles(blocks, block, crack_table.data())};
            state.is_cracked[i] = state.slots[block].cracks != 0 ? 1 : 0;
        }
    });
    order_by_level_and_brick(state, mesh);
}

}  // namespace meniscus::cpu
