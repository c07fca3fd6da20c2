// Vertices by radix sort, triangles by their first vertex: in a time that grows with the mesh, no faster. Sorting by
// comparison would take longer than writing the file.
#include "meniscus/canonical_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace meniscus {
namespace {

constexpr std::uint32_t digit_bits = 11;  // whose counters the first-level cache holds
constexpr std::uint32_t digit_count = 1U << digit_bits;

struct Numbered {
    LatticePosition position;
    std::uint32_t vertex;  ///< in the mesh as it was
};

/// How far a coordinate is from the least one: any two fit.
std::uint32_t offset(std::int32_t coordinate, std::int32_t least) {
    return static_cast<std::uint32_t>(coordinate) - static_cast<std::uint32_t>(least);
}

/// Moves the vertices from one array to the other, ordered by one digit of a coordinate, those with equal digits as
/// they were.
void distribute(const std::vector<Numbered>& from, std::vector<Numbered>& to, std::size_t axis, std::int32_t least,
                std::uint32_t shift) {
    const auto digit = [=](const Numbered& v) { return (offset(v.position[axis], least) >> shift) % digit_count; };
    std::array<std::uint32_t, digit_count + 1> next{};
    for (const Numbered& v : from) ++next[digit(v) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (const Numbered& v : from) to[next[digit(v)]++] = v;
}

std::vector<Numbered> sorted_vertices(const Mesh& mesh) {
    std::vector<Numbered> sorted(mesh.vertices.size());
    if (sorted.empty()) return sorted;
    LatticePosition least = mesh.vertices[0];
    LatticePosition most = least;
    for (std::uint32_t v = 0; v < sorted.size(); ++v) {
        const LatticePosition& p = mesh.vertices[v];
        sorted[v] = {p, v};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            least[axis] = std::min(least[axis], p[axis]);
            most[axis] = std::max(most[axis], p[axis]);
        }
    }
    std::vector<Numbered> moved(sorted.size());
    for (const std::size_t axis : {2U, 1U, 0U}) {
        const auto bits = static_cast<std::uint32_t>(std::bit_width(offset(most[axis], least[axis])));
        for (std::uint32_t shift = 0; shift < bits; shift += digit_bits) {
            distribute(sorted, moved, axis, least[axis], shift);
            std::swap(sorted, moved);
        }
    }
    return sorted;
}

/// Without a branch, which could not be predicted.
Triangle smallest_first(const Triangle& t) {
    const std::size_t first = t[1] < t[0] ? (t[2] < t[1] ? 2 : 1) : (t[2] < t[0] ? 2 : 0);
    const std::array<std::uint32_t, 5> around{t[0], t[1], t[2], t[0], t[1]};
    return {around[first], around[first + 1], around[first + 2]};
}

/// Those of one level. place: of each vertex of the mesh as it was, in the order.
void order_triangles(std::span<const Triangle> triangles, const std::vector<std::uint32_t>& place,
                     std::span<Triangle> ordered) {
    if (triangles.empty()) return;
    std::vector<Triangle> renamed(triangles.size());
    std::vector<std::uint32_t> next(place.size() + 1);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const auto& [a, b, c] = triangles[i];
        renamed[i] = smallest_first({place[a], place[b], place[c]});
        ++next[renamed[i][0] + 1];
    }
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (const Triangle& t : renamed) ordered[next[t[0]]++] = t;
    // Each entry is now the end of its vertex's triangles, which are few.
    for (std::uint32_t v = 0, first = 0; v < place.size(); first = next[v++])
        if (next[v] - first > 1) std::sort(ordered.begin() + first, ordered.begin() + next[v]);
}

/// The same values, in the order of these vertices.
MeshAttribute ordered_attribute(const MeshAttribute& attribute, const std::vector<Numbered>& vertices) {
    MeshAttribute ordered{attribute.name, attribute.type, attribute.components, {}};
    const std::size_t size = attribute.element_bytes();
    ordered.data.resize(vertices.size() * size);
    for (std::size_t v = 0; v < vertices.size(); ++v)
        std::memcpy(ordered.data.data() + v * size, attribute.data.data() + vertices[v].vertex * size, size);
    return ordered;
}

/// Gives the mesh its vertices in order. Returns the place of each.
std::vector<std::uint32_t> order_vertices(const Mesh& mesh, Mesh& ordered) {
    const std::vector<Numbered> vertices = sorted_vertices(mesh);
    const bool normals = mesh.normals.size() == vertices.size();
    ordered.vertices.resize(vertices.size());
    if (normals) ordered.normals.resize(vertices.size());
    std::vector<std::uint32_t> place(vertices.size());
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
        ordered.vertices[v] = vertices[v].position;
        if (normals) ordered.normals[v] = mesh.normals[vertices[v].vertex];
        place[vertices[v].vertex] = v;
    }
    for (const MeshAttribute& attribute : mesh.attributes)
        ordered.attributes.push_back(ordered_attribute(attribute, vertices));
    return place;
}

}  // namespace

Mesh in_canonical_order(const Mesh& mesh) {
    Mesh ordered;
    ordered.cell_size = mesh.cell_size;
    ordered.offset_bits = mesh.offset_bits;
    ordered.levels = mesh.levels;
    ordered.spray.assign(mesh.spray.begin(), mesh.spray.end());
    const std::vector<std::uint32_t> place = order_vertices(mesh, ordered);
    ordered.triangles.resize(mesh.triangles.size());
    for (const auto& [first, count] : mesh.levels)
        order_triangles(std::span(mesh.triangles).subspan(first, count), place,
                        std::span(ordered.triangles).subspan(first, count));
    return ordered;
}

}  // namespace meniscus
