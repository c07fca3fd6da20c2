#include "stages/count_triangles.hpp"

#include <algorithm>

#include "backends/cpu/surface.hpp"
#include "backends/numbering.hpp"
#include "stages/fill_cracks.hpp"

namespace meniscus::cpu {
namespace {

constexpr std::size_t crack_level = static_cast<std::size_t>(TriangleLevel::crack);

void list_band(Surface& s) {
    const auto in_band = [&](std::size_t b) -> std::uint64_t { return s.level[b] != 0 ? 1 : 0; };
    // Sized for all blocks, so that one pass writes it.
    resize_for_overwrite(s.band, s.block_count());
    const std::uint64_t count = s.scan.exclusive(s.workers, s.block_count(), in_band, [&](std::size_t b, std::uint64_t at) {
        if (s.level[b] != 0) s.band[at] = static_cast<std::uint32_t>(b);
    });
    s.band.resize(count);
}

/// The mesh's order: by level, by brick within a level, by base cell within a brick.
void order_by_level_and_brick(Surface& s, Mesh& mesh) {
    const std::size_t bricks = s.grid.bricks.size();
    resize_for_overwrite(s.brick_triangles, bricks);
    const auto each_block = [&](std::size_t brick, const auto& visit) {
        const std::uint32_t end = brick + 1 < bricks ? s.grid.bricks[brick + 1].first : s.block_count();
        for (std::uint32_t block = s.grid.bricks[brick].first; block < end; ++block)
            if (s.level[block] != 0) visit(s.slots[block], s.level[block] - 1U);
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
        require_numbers(total, "the surface has", "triangles");
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
            const std::uint32_t end = b + 1 < bricks ? s.brick_triangles[b + 1][level]
                                                     : mesh.levels[level].first + mesh.levels[level].count;
            brick.ranges[level] = {s.brick_triangles[b][level], end - s.brick_triangles[b][level]};
        }
        if (brick.triangle_count() != 0) mesh.bricks.push_back(brick);
    }
    resize_for_overwrite(mesh.triangles, total);
}

}  // namespace

void count_triangles(Surface& s, Mesh& mesh) {
    list_band(s);
    resize_for_overwrite(s.has_cracks, s.band.size());
    const bool one_level = std::all_of(s.band.begin(), s.band.end(), [&](std::uint32_t b) { return s.level[b] == s.level[s.band[0]]; });
    const BlocksView blocks = s.view();
    s.workers.for_ranges(s.band.size(), 256, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t block = s.band[i];
            s.slots[block] = {count_cell_triangles(blocks, block, cube_table.data()),
                              one_level ? 0 : count_crack_triangles(blocks, block, crack_table.data())};
            s.has_cracks[i] = s.slots[block].cracks != 0 ? 1 : 0;
        }
    });
    order_by_level_and_brick(s, mesh);
}

}  // namespace meniscus::cpu
