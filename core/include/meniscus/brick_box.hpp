// The part of a surface that one of several processes has: that in a box of bricks.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus {

/// x y z in bricks. The brick (x, y, z) covers the world from (x, y, z) to (x + 1, y + 1, z + 1) times its edge, which
/// is brick_cells * world_cell_size(settings).
using BrickCoordinate = std::array<std::int32_t, 3>;

/// The bricks from `low` to below `high`.
struct BrickBox {
    BrickCoordinate low{};
    BrickCoordinate high{};

    bool holds(const BrickCoordinate& brick) const {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (brick[axis] < low[axis] || brick[axis] >= high[axis]) return false;
        return true;
    }
    bool operator==(const BrickBox&) const = default;
};

/// Bricks have coordinates from -brick_end to below brick_end on each axis: that is all the space that a cell size can
/// address.
inline constexpr std::int32_t brick_end = 1 << 16;
inline constexpr BrickBox all_bricks{{-brick_end, -brick_end, -brick_end}, {brick_end, brick_end, brick_end}};

/// Those from the lowest to the highest, both of them among these; any numbers. Throws InvalidInput where the lowest is
/// beyond the highest.
BrickBox bricks_between(const BrickCoordinate& lowest, const BrickCoordinate& highest);

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

/// mesh: closed, in the order of a reconstruction; right in the box and, for the volume, just around it.
SurfacePart part_of(const Mesh& mesh, const Statistics& statistics, const BrickBox& box);

}  // namespace meniscus
