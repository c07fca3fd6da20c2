// The vertices of a cell of level 2 or 3, listed once, so that a triangle's corner is one look-up.
#pragma once

#include <cstdint>

#include "lattice/bits.hpp"
#include "lattice/blocks.hpp"
#include "lattice/host_device.hpp"
#include "lattice/tables/tables.hpp"
#include "steps/place_vertices/place_vertices.hpp"

namespace meniscus {

/// Numbers of the vertices on all edges of this stride, 1 or 2, of a closed cell that cross the surface. The place of
/// an edge is that of its lower end, x + 5 y + 25 z, plus 125 times its axis. A crossed edge of stride 2 has one
/// vertex, on either half.
template <int stride>
class VertexTable {
public:
    MENISCUS_HD VertexTable(const BlocksView& blocks, const ClosedCell& cell) {
        static_assert(stride == 1 || stride == 2, "a longer edge may have several vertices");
        for (int i = 0; i < 8; ++i) {
            const std::uint32_t block = cell.block[i];
            if (block == no_index) continue;  // no edge from its points crosses the surface
            const EdgeMasks& edges = blocks.edges[block];
            const int corner =
                base_cell_size * ((i & 1) + points_a_side * (i >> 1 & 1) + points_a_side * points_a_side * (i >> 2));
            BlockMask shared = ~BlockMask{0};
            for (int axis = 0; axis < 3; ++axis)
                if ((i >> axis & 1) != 0) shared &= low_face(axis);
            std::uint32_t first = blocks.first_vertex[block];
            for (int axis = 0; axis < 3; ++axis) {
                const BlockMask all = edges.axis[axis];
                // Edges that leave the closed cell are no cell's of ours.
                if ((i >> axis & 1) == 0)
                    list(all, shared, stride == 2 ? bit_step(axis) : 0, first, number_ + points * axis + corner);
                first += static_cast<std::uint32_t>(popcount(all));
            }
        }
    }

    /// The vertex on an edge (tables.hpp) of the subcell with this lower corner.
    MENISCUS_HD std::uint32_t operator()(int bit, int edge) const { return number_[place(bit) + edge_place_.of[edge]]; }

private:
    static constexpr int points_a_side = base_cell_size + 1;
    static constexpr int points = points_a_side * points_a_side * points_a_side;

    MENISCUS_HD static constexpr int place(int bit) { return bit + (bit >> 2 & 3) + 9 * (bit >> 4); }

    /// second_half: the bit by which a point on an edge's second half differs from its lower end.
    MENISCUS_HD static void list(BlockMask all, BlockMask shared, int second_half, std::uint32_t first,
                                 std::uint32_t* out) {
        if (shared == ~BlockMask{0}) {
            for (BlockMask left = all; left != 0; left &= left - 1)
                out[place(lowest_bit(left) & ~second_half)] = first++;
            return;
        }
        for (BlockMask left = all & shared; left != 0; left &= left - 1) {
            const BlockMask before = (left & (~left + 1)) - 1;
            out[place(lowest_bit(left) & ~second_half)] = first + static_cast<std::uint32_t>(popcount(all & before));
        }
    }

    struct EdgePlaces {
        int of[12];
    };
    MENISCUS_HD static constexpr EdgePlaces edge_places() {
        EdgePlaces places{};
        for (int edge = 0; edge < 12; ++edge) {
            const int start = edge_start(edge);
            places.of[edge] = points * (edge >> 2) + stride * ((start & 1) + points_a_side * (start >> 1 & 1) +
                                                               points_a_side * points_a_side * (start >> 2));
        }
        return places;
    }

    EdgePlaces edge_place_ = edge_places();  // a member: device code has no static tables
    std::uint32_t number_[3 * points];       // places that no vertex lies on are never read
};

}  // namespace meniscus
