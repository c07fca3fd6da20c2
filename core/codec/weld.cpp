// Vertices of neighboring bricks meet by their integer coordinates.
#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "meniscus/brick_coding.hpp"
#include "meniscus/error.hpp"

namespace meniscus {
namespace {

std::array<std::int32_t, 3> zyx(const std::array<std::int32_t, 3>& p) {
    return {p[2], p[1], p[0]};
}

struct BrickVertex {
    LatticePosition position;
    std::uint32_t brick;   ///< in sorted order
    std::uint32_t vertex;  ///< in that brick
};

}  // namespace

Mesh weld_bricks(std::span<const DecodedBrick> unordered, double cell_size, std::uint32_t offset_bits) {
    std::vector<const DecodedBrick*> bricks;
    for (const DecodedBrick& b : unordered) bricks.push_back(&b);
    std::sort(bricks.begin(), bricks.end(),
              [](const auto* a, const auto* b) { return zyx(a->coordinate) < zyx(b->coordinate); });
    const auto twice = std::adjacent_find(bricks.begin(), bricks.end(),
                                          [](const auto* a, const auto* b) { return a->coordinate == b->coordinate; });
    if (twice != bricks.end()) {
        const auto& c = (*twice)->coordinate;
        throw InvalidInput("brick (" + std::to_string(c[0]) + ", " + std::to_string(c[1]) + ", " +
                           std::to_string(c[2]) + ") occurs twice");
    }

    Mesh mesh;
    mesh.cell_size = cell_size;
    mesh.offset_bits = offset_bits;
    std::vector<BrickVertex> all;
    std::vector<std::vector<std::uint32_t>> welded(bricks.size());
    for (std::uint32_t b = 0; b < bricks.size(); ++b) {
        welded[b].resize(bricks[b]->vertices.size());
        for (std::uint32_t v = 0; v < bricks[b]->vertices.size(); ++v) all.push_back({bricks[b]->vertices[v], b, v});
    }
    std::sort(all.begin(), all.end(), [](const BrickVertex& a, const BrickVertex& b) {
        return a.position != b.position ? zyx(a.position) < zyx(b.position) : a.brick < b.brick;
    });
    const bool has_normals = !bricks.empty() && std::all_of(bricks.begin(), bricks.end(), [](const auto* b) {
        return b->normals.size() == b->vertices.size();
    });
    for (const BrickVertex& v : all) {
        if (mesh.vertices.empty() || mesh.vertices.back() != v.position) {
            mesh.vertices.push_back(v.position);
            if (has_normals) mesh.normals.push_back(bricks[v.brick]->normals[v.vertex]);
        }
        welded[v.brick][v.vertex] = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    }

    for (const DecodedBrick* b : bricks) {
        MeshBrick brick;
        brick.coordinate = b->coordinate;
        mesh.bricks.push_back(brick);
    }
    for (std::size_t level = 0; level < triangle_level_count; ++level) {
        mesh.levels[level].first = static_cast<std::uint32_t>(mesh.triangles.size());
        for (std::size_t b = 0; b < bricks.size(); ++b) {
            TriangleRange& range = mesh.bricks[b].ranges[level];
            range.first = static_cast<std::uint32_t>(mesh.triangles.size());
            for (std::size_t t = 0; t < bricks[b]->triangles.size(); ++t) {
                if (static_cast<std::size_t>(bricks[b]->levels[t]) != level) continue;
                const Triangle& local = bricks[b]->triangles[t];
                mesh.triangles.push_back({welded[b][local[0]], welded[b][local[1]], welded[b][local[2]]});
            }
            range.count = static_cast<std::uint32_t>(mesh.triangles.size()) - range.first;
        }
        mesh.levels[level].count = static_cast<std::uint32_t>(mesh.triangles.size()) - mesh.levels[level].first;
    }
    return mesh;
}

}  // namespace meniscus
