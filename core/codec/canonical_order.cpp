// Vertices and triangles by radix sort, in a time that grows with the mesh, no faster. Sorting by comparison would take
// longer than writing the file. Both are sorted slice by slice, which spares most of the memory and its misses: what a
// slice needs stays in the cache.
#include "meniscus/canonical_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace meniscus {
namespace {

constexpr std::uint32_t digit_bits = 11;  // whose counters the first-level cache holds
constexpr std::uint32_t digit_count = 1U << digit_bits;

/// log2 of the vertices of a slice: they and their triangles stay in the second-level cache.
constexpr std::uint32_t slice_bits = 14;

struct Numbered {
    LatticePosition position;
    std::uint32_t vertex;  ///< index in the mesh that is put in order
};

/// The distance of a coordinate from the least one: uint32 holds it for any two.
std::uint32_t offset(std::int32_t coordinate, std::int32_t least) {
    return static_cast<std::uint32_t>(coordinate) - static_cast<std::uint32_t>(least);
}

/// The least box around vertices.
struct Extent {
    LatticePosition least;
    std::array<std::uint32_t, 3> bits;  ///< number of bits of the greatest offsets

    explicit Extent(std::span<const LatticePosition> vertices) : least(vertices[0]), bits{} {
        LatticePosition most = least;
        for (const LatticePosition& p : vertices)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                least[axis] = std::min(least[axis], p[axis]);
                most[axis] = std::max(most[axis], p[axis]);
            }
        for (std::size_t axis = 0; axis < 3; ++axis)
            bits[axis] = static_cast<std::uint32_t>(std::bit_width(offset(most[axis], least[axis])));
    }
};

/// Moves vertices from one array to the other, ordered by one digit of a coordinate; vertices with equal digits keep
/// their order.
void distribute(const std::vector<Numbered>& from, std::vector<Numbered>& to, std::size_t axis, std::int32_t least,
                std::uint32_t shift) {
    const auto digit = [=](const Numbered& v) { return (offset(v.position[axis], least) >> shift) % digit_count; };
    std::array<std::uint32_t, digit_count + 1> next{};
    for (const Numbered& v : from) ++next[digit(v) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (const Numbered& v : from) to[next[digit(v)]++] = v;
}

/// Sorts vertices that agree in the bits of x from x_bits on. spare: of the same size.
void sort_vertices(std::vector<Numbered>& vertices, std::vector<Numbered>& spare, const Extent& extent,
                   std::uint32_t x_bits) {
    const std::array<std::uint32_t, 3> bits{x_bits, extent.bits[1], extent.bits[2]};
    for (const std::size_t axis : {2U, 1U, 0U})
        for (std::uint32_t shift = 0; shift < bits[axis]; shift += digit_bits) {
            distribute(vertices, spare, axis, extent.least[axis], shift);
            std::swap(vertices, spare);
        }
}

/// The vertices' numbers in their order.
Array<std::uint32_t> order_of(std::span<const LatticePosition> vertices) {
    Array<std::uint32_t> order(vertices.size());
    if (order.empty()) return order;
    const Extent extent(vertices);
    // First by the highest bits of x, then slice by slice.
    const std::uint32_t high_bits = std::min(
        {static_cast<std::uint32_t>(std::bit_width(vertices.size() >> slice_bits)), digit_bits, extent.bits[0]});
    const std::uint32_t shift = extent.bits[0] - high_bits;
    const auto slice_of = [&](const LatticePosition& p) {
        return std::uint64_t{offset(p[0], extent.least[0])} >> shift;  // which may be 32
    };
    std::vector<std::uint32_t> next((std::size_t{1} << high_bits) + 1);
    for (const LatticePosition& p : vertices) ++next[slice_of(p) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (std::uint32_t v = 0; v < order.size(); ++v) order[next[slice_of(vertices[v])]++] = v;
    // Each entry is now the end of its slice.
    std::vector<Numbered> slice, spare;
    for (std::size_t i = 0, first = 0; i + 1 < next.size(); first = next[i++]) {
        slice.resize(next[i] - first);
        spare.resize(slice.size());
        for (std::size_t k = 0; k < slice.size(); ++k) slice[k] = {vertices[order[first + k]], order[first + k]};
        sort_vertices(slice, spare, extent, shift);
        for (std::size_t k = 0; k < slice.size(); ++k) order[first + k] = slice[k].vertex;
    }
    return order;
}

/// Puts the values of vertices in order: a fixed number of an array's elements for each. The array keeps its memory,
/// which may be charged to an account.
template <class T>
void permute(Array<T>& values, std::size_t per_vertex, const Array<std::uint32_t>& order) {
    Array<T> ordered(values.size());
    for (std::size_t v = 0; v < order.size(); ++v)
        std::copy_n(values.data() + order[v] * per_vertex, per_vertex, ordered.data() + v * per_vertex);
    std::copy(ordered.begin(), ordered.end(), values.begin());
}

/// Without a branch, which could not be predicted.
Triangle smallest_first(const Triangle& t) {
    const std::size_t first = t[1] < t[0] ? (t[2] < t[1] ? 2 : 1) : (t[2] < t[0] ? 2 : 0);
    const std::array<std::uint32_t, 5> around{t[0], t[1], t[2], t[0], t[1]};
    return {around[first], around[first + 1], around[first + 2]};
}

/// Moves triangles, in place, to the slices of their first vertices; returns where each slice begins, and the end.
std::vector<std::uint32_t> part_by_slices(std::span<Triangle> triangles, std::size_t vertices) {
    const auto slice_of = [](const Triangle& t) { return t[0] >> slice_bits; };
    std::vector<std::uint32_t> begin((vertices >> slice_bits) + 2);
    for (const Triangle& t : triangles) ++begin[slice_of(t) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::uint32_t> next = begin;
    // The triangle that lies in the place of the moved one is the next to move.
    for (std::uint32_t slice = 0; slice + 1 < begin.size(); ++slice)
        while (next[slice] < begin[slice + 1]) {
            Triangle moving = triangles[next[slice]];
            while (slice_of(moving) != slice) std::swap(moving, triangles[next[slice_of(moving)]++]);
            triangles[next[slice]++] = moving;
        }
    return begin;
}

/// Sorts triangles, each of which begins with the smallest of its vertices.
void sort_triangles(std::span<Triangle> triangles, std::size_t vertices) {
    const std::vector<std::uint32_t> begin = part_by_slices(triangles, vertices);
    std::vector<Triangle> sorted;
    std::vector<std::uint32_t> next((std::size_t{1} << slice_bits) + 1);
    for (std::size_t slice = 0; slice + 1 < begin.size(); ++slice) {
        const std::span<Triangle> own = triangles.subspan(begin[slice], begin[slice + 1] - begin[slice]);
        if (own.empty()) continue;
        const auto vertex = [](const Triangle& t) { return t[0] % (1U << slice_bits); };
        std::fill(next.begin(), next.end(), 0U);
        for (const Triangle& t : own) ++next[vertex(t) + 1];
        std::partial_sum(next.begin(), next.end(), next.begin());
        sorted.resize(own.size());
        for (const Triangle& t : own) sorted[next[vertex(t)]++] = t;
        // Each entry is now the end of its vertex's triangles, which are few.
        std::uint32_t first = 0;
        for (const std::uint32_t end : next) {
            if (end - first > 1) std::sort(sorted.begin() + first, sorted.begin() + end);
            first = end;
        }
        std::copy(sorted.begin(), sorted.end(), own.begin());
    }
}

/// Puts the vertices in order, with normals and attributes, and renames them in the triangles.
void order_vertices(Mesh& mesh) {
    const Array<std::uint32_t> order = order_of(mesh.vertices);
    permute(mesh.vertices, 1, order);
    if (mesh.normals.size() == order.size()) permute(mesh.normals, 1, order);
    for (MeshAttribute& attribute : mesh.attributes) permute(attribute.data, attribute.element_bytes(), order);
    Array<std::uint32_t> place(order.size());
    for (std::uint32_t v = 0; v < place.size(); ++v) place[order[v]] = v;
    for (Triangle& t : mesh.triangles) t = smallest_first({place[t[0]], place[t[1]], place[t[2]]});
}

}  // namespace

void put_in_canonical_order(Mesh& mesh) {
    mesh.bricks.clear();
    mesh.lattice.blocks.clear();
    mesh.lattice.bricks.clear();
    order_vertices(mesh);
    for (const auto& [first, count] : mesh.levels)
        sort_triangles(std::span(mesh.triangles).subspan(first, count), mesh.vertices.size());
}

Mesh in_canonical_order(const Mesh& mesh) {
    Mesh ordered;  // array by array: the account of the mesh is not charged for a copy
    ordered.cell_size = mesh.cell_size;
    ordered.offset_bits = mesh.offset_bits;
    ordered.levels = mesh.levels;
    ordered.vertices.assign(mesh.vertices.begin(), mesh.vertices.end());
    ordered.normals.assign(mesh.normals.begin(), mesh.normals.end());
    ordered.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
    ordered.spray.assign(mesh.spray.begin(), mesh.spray.end());
    for (const MeshAttribute& attribute : mesh.attributes) {
        MeshAttribute& copy = ordered.attributes.emplace_back();
        copy.name = attribute.name;
        copy.type = attribute.type;
        copy.components = attribute.components;
        copy.data.assign(attribute.data.begin(), attribute.data.end());
    }
    put_in_canonical_order(ordered);
    return ordered;
}

}  // namespace meniscus
