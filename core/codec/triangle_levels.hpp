// A triangle's level follows from the places of its vertices.
//
// A crack triangle lies in a face plane of the base-cell grid; a marching-cubes triangle never does, since no diagonal
// of its loop lies in a face of its cube. So every other triangle lies inside one base cell, and the level of that cell
// is its own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "meniscus/mesh.hpp"

namespace meniscus {

/// A vertex in brick-local steps of c / 2^offset_bits.
using LocalPosition = std::array<std::uint16_t, 3>;

/// Index (x + 16 y + 256 z) of the base cell of a brick that holds a triangle; none for a crack triangle.
/// Positions at most brick_cells * 2^offset_bits.
std::optional<std::uint16_t> cell_of_triangle(const LocalPosition& a, const LocalPosition& b, const LocalPosition& c,
                                              std::uint32_t offset_bits);

/// Packs the levels (1, 2, 3; 0 where a cell holds no triangle) of a brick's 4096 base cells: two bits for each that
/// holds some.
std::vector<std::byte> pack_cell_levels(std::span<const std::uint8_t> level_of_cell);

/// The reverse, for the cells marked in `occupied`. Throws InvalidInput if the bytes do not fit.
std::vector<std::uint8_t> unpack_cell_levels(std::span<const std::byte> packed, std::span<const bool> occupied);

}  // namespace meniscus
