// The identity of a mesh's geometry, independent of the order of its triangles and vertices.
#pragma once

#include <string>

#include "meniscus/mesh.hpp"

namespace meniscus {

/// SHA-256, as 64 hexadecimal digits, over (little-endian) cell_size as float64, offset_bits and the triangle count as
/// uint32 and uint64, then every triangle as its level byte (1, 2, 3; crack 0) and 3 x 3 int32 lattice coordinates,
/// rotated so that its smallest vertex (x, then y, then z) comes first, sorted: the order of in_canonical_order(),
/// crack filling first. Normals and attributes do not enter.
std::string mesh_sha256(const Mesh& mesh);

/// The sum modulo 2^256 over the mesh's bricks, as 64 hexadecimal digits, of numbers whose first byte is the highest:
/// SHA-256 over (little-endian) cell_size as float64, offset_bits as uint32, the brick's coordinate as 3 int32, the
/// number of its triangles as uint64, then these as mesh_sha256() has those of a mesh. Where several programs have
/// some bricks each, it is the sum of theirs. 0 for an empty mesh. Throws InvalidInput for triangles without
/// Mesh::bricks.
std::string bricks_sha256(const Mesh& mesh);

}  // namespace meniscus
