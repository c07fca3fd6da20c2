// Vertices of neighboring bricks meet by their integer coordinates.
#include <algorithm>
#include <cstring>
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
    std::uint32_t brick;   ///< index in sorted order
    std::uint32_t vertex;  ///< index in that brick
};

std::string place_name(const DecodedBrick& brick) {
    const auto& c = brick.coordinate;
    return "(" + std::to_string(c[0]) + ", " + std::to_string(c[1]) + ", " + std::to_string(c[2]) + ")";
}

void require_same_attributes(const std::vector<const DecodedBrick*>& bricks) {
    const auto form_is = [](const MeshAttribute& a, const MeshAttribute& b) {
        return a.name == b.name && a.type == b.type && a.components == b.components;
    };
    for (const DecodedBrick* brick : bricks)
        if (!std::ranges::equal(brick->attributes, bricks[0]->attributes, form_is))
            throw InvalidInput("bricks " + place_name(*bricks[0]) + " and " + place_name(*brick) +
                               " have different attributes");
}

/// sources: of the mesh's vertices.
void gather_attributes(const std::vector<const DecodedBrick*>& bricks, const std::vector<BrickVertex>& sources,
                       Mesh& mesh) {
    for (std::size_t a = 0; a < bricks[0]->attributes.size(); ++a) {
        const MeshAttribute& form = bricks[0]->attributes[a];
        MeshAttribute& welded = mesh.attributes.emplace_back(MeshAttribute{form.name, form.type, form.components, {}});
        const std::size_t size = form.element_bytes();
        welded.data.resize(sources.size() * size);
        for (std::size_t v = 0; v < sources.size(); ++v)
            std::memcpy(welded.data.data() + v * size,
                        bricks[sources[v].brick]->attributes[a].data.data() + sources[v].vertex * size, size);
    }
}

}  // namespace

Mesh weld_bricks(std::span<const DecodedBrick> unordered, double cell_size, std::uint32_t offset_bits) {
    std::vector<const DecodedBrick*> bricks;
    for (const DecodedBrick& b : unordered) bricks.push_back(&b);
    std::sort(bricks.begin(), bricks.end(),
              [](const auto* a, const auto* b) { return zyx(a->coordinate) < zyx(b->coordinate); });
    const auto twice = std::adjacent_find(bricks.begin(), bricks.end(),
                                          [](const auto* a, const auto* b) { return a->coordinate == b->coordinate; });
    if (twice != bricks.end()) throw InvalidInput("brick " + place_name(**twice) + " occurs twice");
    require_same_attributes(bricks);

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
    if (!bricks.empty() && !bricks[0]->attributes.empty()) {
        all.erase(std::unique(all.begin(), all.end(),
                              [](const BrickVertex& a, const BrickVertex& b) { return a.position == b.position; }),
                  all.end());
        gather_attributes(bricks, all, mesh);
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
