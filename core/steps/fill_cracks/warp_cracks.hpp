// The subfaces between fine cells and coarser neighbors of the few closed cells of a warp, one in every lane.
#pragma once

#include <cstdint>

#include "engine/cuda/warp.hpp"
#include "engine/cuda/warp_signs.hpp"
#include "lattice/blocks.hpp"
#include "steps/fill_cracks/fill_cracks.hpp"

namespace meniscus::cuda {

/// One coarse subface, with points as places of its cell (ClosedPoints).
struct CrackSubface {
    bool exists;
    unsigned cell;    ///< number among the warp's cells
    bool is_first;    ///< whether it is the first of the cell
    unsigned axis;    ///< normal to the face
    unsigned side;    ///< 0: the coarse cell lies below the fine one, 1: above
    unsigned corner;  ///< its lowest point
    unsigned stride_shift;

    __device__ unsigned u() const { return axis == 2 ? 0 : axis + 1; }
    __device__ unsigned v() const { return axis == 0 ? 2 : axis - 1; }
    /// The point `along_u` and `along_v` strides from the lowest one.
    __device__ unsigned point(unsigned along_u, unsigned along_v) const {
        return corner + ((along_u * ClosedPoints::step(u()) + along_v * ClosedPoints::step(v())) << stride_shift);
    }
    /// The crack case: which of its 3 x 3 points are inside.
    __device__ unsigned crack_case(const ClosedPoints& points, const WarpSigns& signs) const {
        unsigned inside = 0;
        for (unsigned i = 0; i < 9; ++i) inside |= (signs.is_inside(points, cell, point(i % 3, i / 3)) ? 1U : 0U) << i;
        return inside;
    }
};

/// The faces of the warp's cells beyond which a coarser cell lies, in the order of the mesh: cell by cell, by axis,
/// then side.
struct WarpCracks {
    std::uint8_t face[warp_threads];  ///< 8 cell + 2 axis + side, which is the lane that looks it up

    /// Returns the set of faces. The lanes must wait for each other before any reads.
    __device__ std::uint32_t list(const BlocksView& blocks, const CellsOfLanes& cells) {
        const int own = static_cast<int>(lane_index() % 8);
        const bool is_listed = cells.exists && own < 6 &&
                               coarser_neighbor(blocks, cells.block, cells.level, own >> 1, own & 1) != no_index;
        const std::uint32_t listed = __ballot_sync(all_lanes, is_listed ? 1 : 0);
        if (is_listed) face[lanes_below(listed)] = static_cast<std::uint8_t>(lane_index());
        return listed;
    }
    /// Calls visit(subface) in all lanes at once, for neighboring subfaces in neighboring lanes.
    template <class Visit>
    __device__ void for_each_subface_together(const WarpSigns& signs, std::uint32_t listed, const Visit& visit) const {
        const auto subfaces = static_cast<unsigned>(4 * __popc(listed));
        for (unsigned first = 0; first < subfaces; first += warp_threads) {
            const unsigned i = first + lane_index();
            const unsigned own = face[(i < subfaces ? i : 0) / 4];
            CrackSubface s;
            s.cell = own / 8;
            s.axis = own >> 1 & 3;
            s.side = own & 1;
            s.stride_shift = signs.stride_shift[s.cell];
            // A face of the stride 2 is one coarse subface.
            s.exists = i < subfaces && (i % 4 == 0 || s.stride_shift == 0);
            s.is_first = i % 4 == 0 && (listed & ((1U << own) - 1) & 0xFFU << (8 * s.cell)) == 0;
            // Subfaces lie in the order of their lowest points, that is, along the earlier axis first.
            const unsigned low = ClosedPoints::step(s.axis == 0 ? 1 : 0);
            const unsigned high = ClosedPoints::step(s.axis == 2 ? 1 : 2);
            s.corner = base_cell_size * s.side * ClosedPoints::step(s.axis) +
                       (s.exists ? 2 * ((i & 1) * low + (i >> 1 & 1) * high) : 0);
            visit(s);
        }
    }
};

}  // namespace meniscus::cuda
