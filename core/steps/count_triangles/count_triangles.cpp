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

/// Leaves in brick_counts how many come before each brick's.
void list_mixed_cells(State& s) {
    const LevelSets levels = s.level_sets();
    const SignSets signs = s.sign_sets();
    const CellSetView mixed = s.chosen_cells();
    resize_for_overwrite(s.brick_counts, s.grid.bricks.size());
    for_each_brick(s, [&](std::uint32_t brick) {
        std::uint64_t count = 0;
        for_each_word(s.grid.bricks[brick], [&](int w) {
            const std::uint64_t band = levels.band(brick, w);
            mixed.word(brick, w) = band == 0 ? 0 : band & signs.cells_seeing_both(brick, w);
            count += static_cast<std::uint64_t>(popcount(mixed.word(brick, w)));
        });
        s.brick_counts[brick] = count;
    });
    resize_for_overwrite(s.mixed_cells, counts_to_starts(s.brick_counts));
    for_each_brick(s, [&](std::uint32_t brick) {
        std::uint64_t at = s.brick_counts[brick];
        for_each_word(s.grid.bricks[brick], [&](int w) {
            for_each_cell(s.grid.bricks[brick], w, mixed.word(brick, w),
                          [&](std::uint32_t block, int) { s.mixed_cells[at++] = block; });
        });
    });
}

/// The mesh's order: by level, by brick within a level, by base cell within a brick.
void order_by_level_and_brick(State& s, Mesh& mesh) {
    const std::size_t bricks = s.grid.bricks.size();
    resize_for_overwrite(s.brick_triangles, bricks);
    const auto each_block = [&](std::size_t brick, const auto& visit) {
        const std::uint64_t end = brick + 1 < bricks ? s.brick_counts[brick + 1] : s.mixed_cells.size();
        for (std::uint64_t i = s.brick_counts[brick]; i < end; ++i)
            visit(s.slots[s.mixed_cells[i]], s.level[s.mixed_cells[i]] - 1U);
    };
    s.workers.for_ranges(bricks, 4, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) {
            s.brick_triangles[b] = {};
            each_block(b, [&](const TriangleSlots& slots, std::size_t level) {
                s.brick_triangles[b][level] += slots.cells;
                s.brick_triangles[b][crack_level] += slots.cracks;
            });
        }
    });
    std::uint64_t total = 0;
    for (std::size_t level = 0; level < triangle_level_count; ++level) {
        mesh.levels[level].first = static_cast<std::uint32_t>(total);
        for (auto& triangles : s.brick_triangles) {
            const std::uint32_t own = triangles[level];
            triangles[level] = static_cast<std::uint32_t>(total);
            total += own;
        }
        require_indexable(total, "the surface has", "triangles");
        mesh.levels[level].count = static_cast<std::uint32_t>(total) - mesh.levels[level].first;
    }
    s.workers.for_ranges(bricks, 4, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) {
            auto next = s.brick_triangles[b];
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
        const Int3 at = s.grid.bricks[b].coordinate;
        brick.coordinate = {at.x, at.y, at.z};
        for (std::size_t level = 0; level < triangle_level_count; ++level) {
            const std::uint32_t end =
                b + 1 < bricks ? s.brick_triangles[b + 1][level] : mesh.levels[level].first + mesh.levels[level].count;
            brick.ranges[level] = {s.brick_triangles[b][level], end - s.brick_triangles[b][level]};
        }
        if (brick.triangle_count() != 0) mesh.bricks.push_back(brick);
    }
}

}  // namespace

std::array<std::uint64_t, 3> count_band_cells(State& s) {
    std::array<std::uint64_t, 4> of_at_least{};
    for (std::size_t level = 1; level <= 3; ++level)
        for (const std::uint64_t cells : s.at_least[level])
            of_at_least[level] += static_cast<std::uint64_t>(popcount(cells));
    return {of_at_least[1] - of_at_least[2], of_at_least[2] - of_at_least[3], of_at_least[3]};
}

void count_triangles(State& s, Mesh& mesh) {
    list_mixed_cells(s);
    resize_for_overwrite(s.is_cracked, s.mixed_cells.size());
    const bool one_level = std::all_of(s.mixed_cells.begin(), s.mixed_cells.end(),
                                       [&](std::uint32_t b) { return s.level[b] == s.level[s.mixed_cells[0]]; });
    const BlocksView blocks = s.blocks();
    s.workers.for_ranges(s.mixed_cells.size(), 256, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t block = s.mixed_cells[i];
            s.slots[block] = {count_cell_triangles(blocks, block, cube_table.data()),
                              one_level ? 0 : count_crack_triangles(blocks, block, crack_table.data())};
            s.is_cracked[i] = s.slots[block].cracks != 0 ? 1 : 0;
        }
    });
    order_by_level_and_brick(s, mesh);
}

}  // namespace meniscus::cpu
