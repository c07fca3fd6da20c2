// The numbers of the vertices on a few closed cells' edges, found by counting bits in a warp's shared memory, and the
// cube table in the same words.
//
// A closed cell's points lie at places x + 5 y + 25 z, coordinates 0 to 4.
#pragma once

#include <cstdint>

#include "engine/cuda/warp.hpp"
#include "steps/count_triangles/warp_signs.hpp"

namespace meniscus::cuda {

MENISCUS_HD constexpr int point_place(int x, int y, int z) {
    return x + points_a_side * (y + points_a_side * z);
}

/// The cube table by triangles, and where the points of a closed cell lie. For a block of threads.
struct TriangleRows {
    static constexpr unsigned most = 5;  ///< triangles of a case
    static constexpr int points = points_a_side * points_a_side * points_a_side;

    struct Point {
        std::uint32_t below;  ///< the bits below the point's own in its half word
        std::uint32_t half;   ///< the number of that
    };
    Point point[points];
    /// Row 5 case + triangle. Corner k, from bit 10 k on: the place where its edge starts (5 bits), and the axis (2).
    std::uint32_t row[cube_case_count * most];
    std::uint8_t triangles[cube_case_count];

    /// All threads of a block must call this, and wait for each other before any reads.
    __device__ void fill(const CubeCase* table) {
        static_assert(block_threads == cube_case_count && block_threads >= points);
        const unsigned i = threadIdx.x;
        const CubeCase& pattern = table[i];
        triangles[i] = pattern.triangles;
        for (unsigned t = 0; t < most; ++t) {
            std::uint32_t corners = 0;
            for (unsigned k = 0; k < 3; ++k) {
                const int edge = pattern.edges[3 * t + k];
                const int start = edge_start(edge);
                const int place = point_place(start & 1, start >> 1 & 1, start >> 2);
                corners |= static_cast<std::uint32_t>(place | (edge >> 2) << 5) << (10 * k);
            }
            row[most * i + t] = corners;
        }
        if (i >= points) return;
        const int place = static_cast<int>(i);
        const int x = place % points_a_side;
        const int y = place / points_a_side % points_a_side;
        const int z = place / (points_a_side * points_a_side);
        const int bit = ClosedCell::bit(x, y, z);
        const int block = x >> 2 | (y >> 2) << 1 | (z >> 2) << 2;
        point[i] = {(1U << (bit & 31)) - 1, static_cast<std::uint32_t>(2 * block + (bit >> 5))};
    }
};

struct VertexCounts {
    /// Half a word of a block's edges along an axis that carry a vertex.
    struct alignas(8) Edges {
        std::uint32_t mask;
        std::uint32_t first;  ///< number of its first vertex
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
    __device__ std::uint32_t vertex(const TriangleRows& table, const WarpSigns& signs, unsigned cell, unsigned place,
                                    unsigned axis, unsigned stride_shift) const {
        if (stride_shift != 0) {
            const auto is_inside = [&](unsigned at) {
                const TriangleRows::Point& point = table.point[at];
                return (signs.inside[cell][point.half] & (point.below + 1)) != 0;
            };
            const unsigned step = axis == 0 ? 1 : axis == 1 ? points_a_side : points_a_side * points_a_side;
            for (unsigned half = step << (stride_shift - 1); half >= step; half /= 2)
                if (is_inside(place) == is_inside(place + half)) place += half;
        }
        const TriangleRows::Point& point = table.point[place];
        const Edges& of_half = edges[cell][axis][point.half];
        return of_half.first + static_cast<std::uint32_t>(__popc(of_half.mask & point.below));
    }
};

}  // namespace meniscus::cuda
