// The part of a surface that one of several processes has: that in a box of bricks.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus {

/// Bricks from the lowest to the highest, both of them among these; by itself all bricks. The brick (x, y, z) covers
/// the world from (x, y, z) to (x + 1, y + 1, z + 1) times its edge, which is brick_cells * world_cell_size(settings).
struct BrickBox {
    std::array<std::int32_t, 3> lowest{std::numeric_limits<std::int32_t>::min(),
                                       std::numeric_limits<std::int32_t>::min(),
                                       std::numeric_limits<std::int32_t>::min()};
    std::array<std::int32_t, 3> highest{std::numeric_limits<std::int32_t>::max(),
                                        std::numeric_limits<std::int32_t>::max(),
                                        std::numeric_limits<std::int32_t>::max()};

    bool contains(const std::array<std::int32_t, 3>& brick) const {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (brick[axis] < lowest[axis] || brick[axis] > highest[axis]) return false;
        return true;
    }
    bool operator==(const BrickBox&) const = default;
};

/// How far around its box a process needs particles so that the bricks in it are those of the whole frame, radii of the
/// coarsest particles (core/README.md#parts-of-a-frame): margin(), and in Mode::adaptive base cells beyond, as a level
/// follows those of its neighbors.
double halo(const Settings& settings);

/// What a process with the bricks of a box says of them beside their bytes. Of boxes that cover all bricks, without an
/// overlap, the parts add up to the whole surface.
struct SurfacePart {
    std::vector<std::uint32_t> bricks;   ///< numbers of those of Mesh::bricks
    std::vector<AttributeRange> ranges;  ///< of each attribute over the vertices of the bricks; none without vertices
    std::vector<Point> spray;            ///< places in the box
    /// Counts of the mesh are those of the box; a vertex of several bricks counts in the first of them. The volume is
    /// that of the fluid within the box. Of the particles a process knows those of its neighbors, too: their number and
    /// volume, those of spray but where the mesh has its places, and what the work took, are as the reconstruction has
    /// them.
    Statistics statistics;
};

/// mesh: closed, in the order of a reconstruction; right in the box and, for the volume, just around it. Throws
/// InvalidInput for a box whose lowest brick is beyond its highest.
SurfacePart part_of(const Mesh& mesh, const Statistics& statistics, const BrickBox& box);

}  // namespace meniscus
