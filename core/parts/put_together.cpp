// The whole mesh of those of its parts: vertices and triangles in the order of a reconstruction of the whole.
#include <algorithm>
#include <array>
#include <compare>
#include <cstring>
#include <string>

#include "engine/index_limit.hpp"
#include "lattice/block_mask.hpp"
#include "lattice/brick_grid.hpp"
#include "meniscus/error.hpp"
#include "meniscus/parts.hpp"

namespace meniscus {
namespace {

/// A vertex's place in the order of a mesh: by the brick and the block that its finest edge starts in, by axis, then by
/// the point where it starts.
struct VertexPlace {
    std::uint64_t brick;
    std::uint32_t in_brick;
    std::uint32_t part;
    std::uint32_t number;  ///< in its part's mesh

    VertexPlace(const LatticePosition& p, int bits, std::uint32_t of_part, std::uint32_t of_mesh)
        : part(of_part), number(of_mesh) {
        // The edge's axis is the one along which the vertex lies on no lattice point.
        std::uint32_t axis = 0;
        while (axis < 2 && (p[axis] & ((1 << bits) - 1)) == 0) ++axis;
        const Int3 point{p[0] >> bits, p[1] >> bits, p[2] >> bits};
        const auto base = [](std::int32_t cell) { return cell >> 2; };
        const Int3 block{base(point.x), base(point.y), base(point.z)};
        brick = brick_key(brick_of(block));
        const auto bit = static_cast<std::uint32_t>(point_bit(point.x & 3, point.y & 3, point.z & 3));
        in_brick = (static_cast<std::uint32_t>(index_in_brick(block)) * 3 + axis) * 64 + bit;
    }
    bool is_at(const VertexPlace& o) const { return brick == o.brick && in_brick == o.in_brick; }
    bool operator<(const VertexPlace& o) const {
        if (brick != o.brick) return brick < o.brick;
        if (in_brick != o.in_brick) return in_brick < o.in_brick;
        return part < o.part;
    }
};
static_assert(base_cell_size == 4);

void require_alike(std::span<const Mesh> parts) {
    for (const Mesh& part : parts) {
        const Mesh& first = parts.front();
        if (part.cell_size != first.cell_size || part.offset_bits != first.offset_bits)
            throw InvalidInput("parts of a mesh have cells of " + std::to_string(first.cell_size) + " and of " +
                               std::to_string(part.cell_size) + " with " + std::to_string(first.offset_bits) + " and " +
                               std::to_string(part.offset_bits) + " bits: all must have the same settings");
        const bool alike = std::equal(part.attributes.begin(), part.attributes.end(), first.attributes.begin(),
                                      first.attributes.end(), [](const MeshAttribute& a, const MeshAttribute& b) {
                                          return a.name == b.name && a.type == b.type && a.components == b.components;
                                      });
        if (!alike) throw InvalidInput("parts of a mesh have different attributes: all must have the same settings");
    }
}

/// Which vertex of the whole each vertex of each part is.
using Numbers = std::vector<std::vector<std::uint32_t>>;

/// Writes the vertices with their normals and attributes.
Numbers put_vertices(std::span<const Mesh> parts, Mesh& whole) {
    Numbers numbers(parts.size());
    std::vector<VertexPlace> places;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const Mesh& part = parts[p];
        numbers[p].resize(part.vertices.size());
        for (std::size_t v = 0; v < part.vertices.size(); ++v)
            places.emplace_back(part.vertices[v], static_cast<int>(part.offset_bits), static_cast<std::uint32_t>(p),
                                static_cast<std::uint32_t>(v));
    }
    std::sort(places.begin(), places.end());
    std::vector<VertexPlace> firsts;
    for (const VertexPlace& place : places) {
        if (firsts.empty() || !firsts.back().is_at(place)) firsts.push_back(place);
        numbers[place.part][place.number] = static_cast<std::uint32_t>(firsts.size() - 1);
    }
    require_indexable(firsts.size(), "the surface has", "vertices");
    whole.vertices.resize(firsts.size());
    const bool has_normals = std::any_of(parts.begin(), parts.end(), [](const Mesh& m) { return !m.normals.empty(); });
    if (has_normals) whole.normals.resize(firsts.size());
    for (MeshAttribute& attribute : whole.attributes) attribute.data.resize(firsts.size() * attribute.element_bytes());
    for (std::size_t i = 0; i < firsts.size(); ++i) {
        const auto& [brick, in_brick, p, v] = firsts[i];
        whole.vertices[i] = parts[p].vertices[v];
        if (has_normals) whole.normals[i] = parts[p].normals[v];
        for (std::size_t a = 0; a < whole.attributes.size(); ++a) {
            const std::size_t bytes = whole.attributes[a].element_bytes();
            std::memcpy(whole.attributes[a].data.data() + i * bytes, parts[p].attributes[a].data.data() + v * bytes,
                        bytes);
        }
    }
    return numbers;
}

/// A brick of a part.
struct PartBrick {
    std::uint64_t key;
    std::uint32_t part;
    std::uint32_t brick;  ///< index in its mesh
};

std::vector<PartBrick> bricks_of(std::span<const Mesh> parts) {
    std::vector<PartBrick> bricks;
    for (std::size_t p = 0; p < parts.size(); ++p)
        for (std::size_t b = 0; b < parts[p].bricks.size(); ++b) {
            const BrickCoordinate& at = parts[p].bricks[b].coordinate;
            bricks.push_back(
                {brick_key({at[0], at[1], at[2]}), static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(b)});
        }
    std::sort(bricks.begin(), bricks.end(), [](const PartBrick& a, const PartBrick& b) { return a.key < b.key; });
    for (std::size_t i = 1; i < bricks.size(); ++i)
        if (bricks[i].key == bricks[i - 1].key)
            throw InvalidInput("two parts of a mesh have the same brick: each brick is one part's own");
    return bricks;
}

}  // namespace

Mesh put_together(std::span<const Mesh> parts) {
    Mesh whole;
    if (parts.empty()) return whole;
    require_alike(parts);
    const std::vector<PartBrick> bricks = bricks_of(parts);
    whole.cell_size = parts.front().cell_size;
    whole.offset_bits = parts.front().offset_bits;
    for (const MeshAttribute& attribute : parts.front().attributes)
        whole.attributes.push_back({attribute.name, attribute.type, attribute.components, {}});
    const Numbers numbers = put_vertices(parts, whole);
    std::uint64_t triangles = 0;
    for (const Mesh& part : parts) {
        triangles += part.triangles.size();
        whole.spray.insert(whole.spray.end(), part.spray.begin(), part.spray.end());
    }
    require_indexable(triangles, "the surface has", "triangles");
    whole.triangles.reserve(triangles);
    whole.bricks.resize(bricks.size());
    for (std::size_t level = 0; level < triangle_level_count; ++level) {
        whole.levels[level].first = static_cast<std::uint32_t>(whole.triangles.size());
        for (std::size_t b = 0; b < bricks.size(); ++b) {
            const Mesh& part = parts[bricks[b].part];
            const MeshBrick& brick = part.bricks[bricks[b].brick];
            const TriangleRange& range = brick.ranges[level];
            whole.bricks[b].coordinate = brick.coordinate;
            whole.bricks[b].ranges[level] = {static_cast<std::uint32_t>(whole.triangles.size()), range.count};
            for (const Triangle& t : std::span(part.triangles).subspan(range.first, range.count)) {
                const std::vector<std::uint32_t>& of = numbers[bricks[b].part];
                whole.triangles.push_back({of[t[0]], of[t[1]], of[t[2]]});
            }
        }
        whole.levels[level].count = static_cast<std::uint32_t>(whole.triangles.size()) - whole.levels[level].first;
    }
    return whole;
}

}  // namespace meniscus
