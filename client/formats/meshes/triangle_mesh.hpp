// A triangle mesh as files have it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "formats/containers/named_values.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::formats {

/// Whether float32 may round two neighboring lattice points of this mesh to one value, so that files need float64.
/// That begins at 2^23 lattice units: float32 has 24 significant bits, and just above a power of two its steps are
/// 2^-23 of the value.
bool needs_double(const Mesh& mesh);
/// farthest: the greatest magnitude of a coordinate of its vertices, lattice units.
constexpr bool needs_double(std::uint64_t farthest) {
    return farthest >= std::uint64_t{1} << 23U;
}

/// A convex quadrilateral by its corners' indices, counter-clockwise seen from outside.
using Quad = std::array<std::uint32_t, 4>;

/// A triangle mesh from a file of any program.
struct TriangleMesh {
    std::vector<std::array<double, 3>> positions;
    std::vector<Normal> normals;            ///< empty, or one per position
    std::vector<Triangle> triangles;        ///< indices into `positions`, checked
    std::vector<std::uint8_t> levels;       ///< empty, or per triangle 1, 2, 3, crack 0
    std::vector<NamedValues> attributes;    ///< of the positions
    bool wide = false;                      ///< float32 would merge positions, or round them: files need float64
    std::vector<Quad> quads;                ///< beside the triangles, of the formats that have them; readers make none
    std::vector<std::uint8_t> quad_levels;  ///< empty, or per quadrilateral as `levels`
};

TriangleMesh to_triangles(const Mesh& mesh);
/// The triangles and quadrilaterals have none afterwards.
void leave_out_levels(TriangleMesh& mesh);

}  // namespace meniscus::formats
