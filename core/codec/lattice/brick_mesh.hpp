// The vertices and the triangles of a brick, from its lattice.
#pragma once

#include <cstdint>

#include "codec/lattice/lattice_brick.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus {

/// Calls visit(place of the block, axis, bit of the edge's lower end) for every vertex, in the order of their numbers.
template <class Visit>
void for_each_vertex(const BrickLattice& lattice, const Visit& visit) {
    for (const std::uint16_t place : lattice.blocks())
        for (int axis = 0; axis < 3; ++axis)
            for (BlockMask left = lattice.edges[place].axis[axis]; left != 0; left &= left - 1)
                visit(int{place}, axis, lowest_bit(left));
}

/// Places the vertices, relative to `origin` in steps of c / 2^offset_bits, and writes the triangles: cell by cell,
/// each cell's own before the filling of its faces. The lattice is drawable, has its coarser faces, and its vertices
/// are numbered. Returns whether the triangles are exactly this many; there are no more in memory.
bool make_mesh(LatticeBrick& brick, const LatticePosition& origin, std::uint32_t triangles);

}  // namespace meniscus
