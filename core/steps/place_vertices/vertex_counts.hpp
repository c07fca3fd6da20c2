// The numbers of the vertices on a few closed cells' edges, found by counting bits in a warp's shared memory.
#pragma once

#include <cstdint>

#include "engine/cuda/warp.hpp"
#include "engine/cuda/warp_signs.hpp"
#include "lattice/blocks.hpp"

namespace meniscus::cuda {

struct VertexCounts {
    /// Half a word of a block's edges along an axis that carry a vertex.
    struct alignas(8) Edges {
        std::uint32_t mask;
        std::uint32_t first;  ///< number of the first vertex of this half word
    };
    Edges edges[closed_cells_a_warp][3][closed_half_words];

    /// The lanes must wait for each other before any reads.
    __device__ void put(const BlocksView& blocks, const CellsOfLanes& cells) {
        const bool exists = cells.own != no_index;
        std::uint32_t first = exists ? blocks.first_vertex[cells.own] : 0;
        for (int axis = 0; axis < 3; ++axis) {
            const BlockMask mask = exists ? blocks.edges[cells.own].axis[axis] : 0;
            Edges* const halves = &edges[lane_index() / 8][axis][2 * (lane_index() % 8)];
            for (int i = 0; i < 2; ++i) {
                halves[i] = {static_cast<std::uint32_t>(mask >> (32 * i)), first};
                first += static_cast<std::uint32_t>(__popc(halves[i].mask));
            }
        }
    }
    /// Number of the vertex on the edge of stride 2^stride_shift that starts at a place of a cell and crosses the
    /// surface.
    __device__ std::uint32_t vertex(const ClosedPoints& points, const WarpSigns& signs, unsigned cell, unsigned place,
                                    unsigned axis, unsigned stride_shift) const {
        if (stride_shift != 0) {
            const unsigned step = ClosedPoints::step(axis);
            for (unsigned half = step << (stride_shift - 1); half >= step; half /= 2)
                if (signs.is_inside(points, cell, place) == signs.is_inside(points, cell, place + half)) place += half;
        }
        const ClosedPoints::Point point = points.point[place];
        const Edges& of_half = edges[cell][axis][point.half];
        return of_half.first + static_cast<std::uint32_t>(__popc(of_half.mask & point.below));
    }
};

}  // namespace meniscus::cuda
