// The surface: a welded, indexed, closed and oriented triangle mesh in exact lattice coordinates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "meniscus/element_type.hpp"
#include "meniscus/memory.hpp"
#include "meniscus/names.hpp"
#include "meniscus/surface_lattice.hpp"

namespace meniscus {

/// Edge of a base cell (a level-1 cell of the paper), in finest cells.
inline constexpr int base_cell_size = 4;
/// Edge of a brick, the unit of encoding and streaming, in base cells and in finest cells.
inline constexpr int brick_base_cells = 16;
inline constexpr int brick_cells = brick_base_cells * base_cell_size;
/// Neither triangles nor vertices of a brick are more: sixteen for each of its finest cells.
inline constexpr std::uint32_t max_brick_triangles = 16U * brick_cells * brick_cells * brick_cells;
/// The least and the most that Mesh::offset_bits can be; the most comes of the longest bisection.
inline constexpr std::uint32_t min_offset_bits = 2;
inline constexpr std::uint32_t max_offset_bits = 8;
static_assert((brick_cells << max_offset_bits) <= 0xFFFF, "brick-local positions are uint16");

/// The kinds of triangle, in the order in which a mesh holds them (the paper's Figure 8d).
enum class TriangleLevel : std::uint8_t { level1 = 0, level2 = 1, level3 = 2, crack = 3 };
constexpr std::string_view name_of(TriangleLevel level) {
    switch (level) {
        case TriangleLevel::level1:
            return "level1";
        case TriangleLevel::level2:
            return "level2";
        case TriangleLevel::level3:
            return "level3";
        case TriangleLevel::crack:
            return "crack";
    }
    return {};
}
inline constexpr std::size_t triangle_level_count = choices<TriangleLevel>.size();

/// The byte that files and the mesh hash use for a triangle's level: 1, 2, 3, and 0 for crack filling.
inline constexpr std::uint8_t level_byte(TriangleLevel level) {
    return level == TriangleLevel::crack ? std::uint8_t{0} : static_cast<std::uint8_t>(static_cast<int>(level) + 1);
}

/// A point of the lattice refined by 2^offset_bits: exact, and a vertex's identity.
using LatticePosition = std::array<std::int32_t, 3>;
using Normal = std::array<float, 3>;
using Point = std::array<float, 3>;  ///< world units
using Triangle = std::array<std::uint32_t, 3>;

struct TriangleRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

/// A brick that holds triangles. A crack triangle belongs to the brick of the finer of its two cells.
struct MeshBrick {
    std::array<std::int32_t, 3> coordinate{};  ///< x y z in bricks; its lattice origin is coordinate * brick_cells
    std::array<TriangleRange, triangle_level_count> ranges{};  ///< ranges of Mesh::triangles, indexed by TriangleLevel
    std::uint32_t triangle_count() const {
        return ranges[0].count + ranges[1].count + ranges[2].count + ranges[3].count;
    }
};

/// The vertices' values of an array of the particles: the mean of the particles near, weighted as the field weights
/// them; of ids, that of the particle with the largest weight.
struct MeshAttribute {
    std::string name;
    ElementType type = ElementType::float32;
    std::size_t components = 1;  ///< numbers per vertex
    Array<std::byte> data;       ///< element_bytes() for each vertex, one vertex after the other

    std::size_t element_bytes() const { return size_of(type) * components; }
};

/// Triangles are ordered by level, by brick (z, y, x) within a level; they run counter-clockwise seen from outside.
struct Mesh {
    double cell_size = 0.0;           ///< finest cell's edge c, world units
    std::uint32_t offset_bits = 0;    ///< vertices lie on multiples of c / 2^offset_bits: min_ to max_offset_bits
    Array<LatticePosition> vertices;  ///< positions of the vertices, unique
    Array<Normal> normals;            ///< unit length, outward, one per vertex; empty if Settings::normals is false
    Array<Triangle> triangles;        ///< indices into `vertices`
    std::array<TriangleRange, triangle_level_count> levels{};  ///< ranges of `triangles`
    Array<MeshBrick> bricks;                                   ///< ordered by coordinate (z, y, x)
    std::vector<MeshAttribute> attributes;                     ///< attributes that the settings name, in that order
    Array<Point> spray;  ///< places of the particles left out of the surface, in no order of the frame's; Spray::points

    SurfaceLattice lattice;  ///< empty unless BackendOptions::keep_lattice asks for it

    /// World position of a lattice position of this mesh: exact product in double, one rounding.
    std::array<double, 3> world(const LatticePosition& p) const {
        const double unit = cell_size / static_cast<double>(1U << offset_bits);
        return {p[0] * unit, p[1] * unit, p[2] * unit};
    }
    TriangleLevel level_of(std::size_t triangle) const {
        for (std::size_t l = 0; l + 1 < triangle_level_count; ++l)
            if (triangle < std::size_t{levels[l].first} + levels[l].count) return static_cast<TriangleLevel>(l);
        return TriangleLevel::crack;
    }
    /// Leaves every array empty, with its memory, and the attributes their names and forms.
    void clear();
};

}  // namespace meniscus
