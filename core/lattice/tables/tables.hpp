// The marching-cubes table (Lorensen and Cline 1987) and the crack patterns (the paper's Section 4), both generated at
// compile time from the face rule. Why patterns have nine signs: core/README.md#why-nine-signs
#pragma once

#include <array>
#include <cstdint>

#include "lattice/host_device.hpp"

namespace meniscus {

/// Triangles of one cube case, as edges of the cube, counter-clockwise seen from outside the fluid.
/// Corner i is at (i & 1, i >> 1 & 1, i >> 2). Edge 4 d + k runs along axis d from the corner whose other two
/// coordinates (in the order x, y, z) are k & 1 and k >> 1.
struct CubeCase {
    std::uint8_t triangles = 0;
    std::array<std::uint8_t, 15> edges{};
};

/// The corner (x + 2 y + 4 z) at which an edge of the cube starts.
MENISCUS_HD constexpr int edge_start(int edge) {
    const int k = edge & 3;
    const int axis = edge >> 2;
    return axis == 0 ? k << 1 : axis == 1 ? (k & 1) | (k & 2) << 1 : k;
}

/// Triangles that close the gap on one face between a coarse cell and the fine cells beyond, as edges of the fine side.
/// The face's points are u + 3 v, with u x v = the face's axis. Edge u + 2 v (0 to 5) runs along u, edge 6 + u + 3 v (6
/// to 11) along v. Oriented for the fine side being the one in the direction of the axis; reversed otherwise.
struct CrackCase {
    std::uint8_t triangles = 0;
    std::array<std::uint8_t, 24> edges{};
};

inline constexpr int cube_case_count = 256;   ///< a case for each set of inside corners
inline constexpr int crack_case_count = 512;  ///< a case for each set of inside points of the fine side

using CubeTable = std::array<CubeCase, cube_case_count>;
using CrackTable = std::array<CrackCase, crack_case_count>;

extern const CubeTable cube_table;
extern const CrackTable crack_table;

}  // namespace meniscus
