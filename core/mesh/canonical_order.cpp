// Vertices by radix sort, triangles by their first vertex: in a time that grows with the mesh, no faster. Sorting by
// comparison would take about as long as writing the file.
#include "meniscus/canonical_order.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace meniscus {
namespace {

struct Numbered {
    LatticePosition position;
    std::uint32_t vertex;  ///< in the mesh as it was
};

/// Moves the vertices from one array to the other, ordered by one digit of a coordinate, those with equal digits as they
/// were.
void distribute(const std::vector<Numbered>& from, std::vector<Numbered>& to, std::size_t axis, std::int32_t least,
                std::uint32_t shift, std::uint32_t digits) {
    const auto digit = [&](const Numbered& v) {
        const auto offset = static_cast<std::uint32_t>(v.position[axis]) - static_cast<std::uint32_t>(least);
        return (offset >> shift) % digits;
    };
    std::vector<std::size_t> next(std::size_t{digits} + 1);
    for (const Numbered& v : from) ++next[digit(v) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (const Numbered& v : from) to[next[digit(v)]++] = v;
}

std::vector<Numbered> sorted_vertices(const Mesh& mesh) {
    constexpr std::uint32_t digit_bits = 11;  // as many counters as the first-level cache holds
    std::vector<Numbered> sorted(mesh.vertices.size());
    for (std::uint32_t v = 0; v < sorted.size(); ++v) sorted[v] = {mesh.vertices[v], v};
    if (sorted.empty()) return sorted;
    std::vector<Numbered> moved(sorted.size());
    for (const std::size_t axis : {2U, 1U, 0U}) {
        const auto [least, most] =
            std::minmax_element(sorted.begin(), sorted.end(), [axis](const Numbered& a, const Numbered& b) {
                return a.position[axis] < b.position[axis];
            });
        const std::int32_t low = least->position[axis];
        const std::uint32_t extent =
            static_cast<std::uint32_t>(most->position[axis]) - static_cast<std::uint32_t>(low);
        const auto bits = static_cast<std::uint32_t>(std::bit_width(extent));
        for (std::uint32_t shift = 0; shift < bits; shift += digit_bits) {
            distribute(sorted, moved, axis, low, shift, 1U << digit_bits);
            std::swap(sorted, moved);
        }
    }
    return sorted;
}

Triangle smallest_first(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

/// Those of one level. place: of each vertex of the mesh as it was, in the order.
void order_triangles(const Mesh& mesh, const TriangleRange& range, const std::vector<std::uint32_t>& place,
                     Array<Triangle>& ordered) {
    const auto triangle = [&](std::uint32_t i) {
        const Triangle& t = mesh.triangles[range.first + i];
        return smallest_first({place[t[0]], place[t[1]], place[t[2]]});
    };
    if (range.count == 0) return;
    std::vector<std::uint32_t> next(place.size() + 1);
    for (std::uint32_t i = 0; i < range.count; ++i) ++next[triangle(i)[0] + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    const auto level = ordered.begin() + range.first;
    for (std::uint32_t i = 0; i < range.count; ++i) {
        const Triangle t = triangle(i);
        level[next[t[0]]++] = t;
    }
    // Each entry is now the end of its vertex's triangles.
    for (std::uint32_t v = 0, first = 0; v < place.size(); first = next[v++])
        if (next[v] - first > 1) std::sort(level + first, level + next[v]);
}

}  // namespace

Mesh in_canonical_order(const Mesh& mesh) {
    const std::vector<Numbered> vertices = sorted_vertices(mesh);
    const bool normals = mesh.normals.size() == vertices.size();
    Mesh ordered;
    ordered.cell_size = mesh.cell_size;
    ordered.offset_bits = mesh.offset_bits;
    ordered.levels = mesh.levels;
    ordered.spray.assign(mesh.spray.begin(), mesh.spray.end());
    ordered.vertices.resize(vertices.size());
    if (normals) ordered.normals.resize(vertices.size());
    std::vector<std::uint32_t> place(vertices.size());
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
        ordered.vertices[v] = vertices[v].position;
        if (normals) ordered.normals[v] = mesh.normals[vertices[v].vertex];
        place[vertices[v].vertex] = v;
    }
    ordered.triangles.resize(mesh.triangles.size());
    for (const TriangleRange& range : mesh.levels) order_triangles(mesh, range, place, ordered.triangles);
    return ordered;
}

}  // namespace meniscus
