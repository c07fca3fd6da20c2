// The signs on a common face of two base cells, seen on the finer grid of the two.
#pragma once

#include "lattice/blocks.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// For every point of a face as the lowest corner of a coarse subface: the signs of the subface's 3 x 3 points,
/// `stride` apart, u + 3 v with u x v = the face's axis.
struct FaceSigns {
    BlockMask inside[9];
    BlockMask subfaces;  ///< lowest corners of the coarse subfaces, in the upper cell's block

    /// upper: the stored cell whose lower face along the axis this is. Points without a value are outside.
    MENISCUS_HD FaceSigns(const BlocksView& blocks, std::uint32_t upper, int axis, int stride)
        : FaceSigns(blocks, upper, axis, stride, [&](std::uint32_t block) { return blocks.inside_or_none(block); }) {}
    /// The same, with points without a value inside.
    MENISCUS_HD static FaceSigns possible(const BlocksView& blocks, std::uint32_t upper, int axis, int stride) {
        return {blocks, upper, axis, stride, [&](std::uint32_t block) {
                    return block == no_index ? BlockMask{0} : blocks.inside[block] | ~blocks.sampled[block];
                }};
    }
    /// The same, of the signs of the four blocks that hold the face's points: the upper cell's, and those up u and v.
    MENISCUS_HD FaceSigns(BlockMask own, BlockMask up_u, BlockMask up_v, BlockMask up_uv, int axis, int stride)
        : subfaces(stride_points(2 * stride) & low_face(axis)) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        for (int i = 0; i < 3; ++i) {
            const BlockMask low = shifted(own, up_u, u, i * stride);
            const BlockMask high = shifted(up_v, up_uv, u, i * stride);
            for (int j = 0; j < 3; ++j) inside[i + 3 * j] = shifted(low, high, v, j * stride);
        }
    }
    /// Subfaces that see both signs.
    MENISCUS_HD BlockMask mixed() const {
        return (corners_any() | middles_any()) & ~(corners_all() & middles_all()) & subfaces;
    }
    /// Subfaces whose corners agree, and hide a point of the other sign.
    MENISCUS_HD BlockMask hiding() const { return hiding(*this); }
    /// The same, where the points that have no value yet are no evidence: they are outside here, and inside in
    /// `possible`.
    MENISCUS_HD BlockMask hiding(const FaceSigns& possible) const {
        return ((middles_any() & ~possible.corners_any()) | (corners_all() & ~possible.middles_all())) & subfaces;
    }
    /// The points of a subface that are inside, as bits u + 3 v.
    MENISCUS_HD int pattern(int bit) const {
        int points = 0;
        for (int i = 0; i < 9; ++i) points |= static_cast<int>(inside[i] >> bit & 1) << i;
        return points;
    }

private:
    /// inside_of: a block's points that are inside; none where no block is stored.
    template <class InsideOf>
    MENISCUS_HD FaceSigns(const BlocksView& blocks, std::uint32_t upper, int axis, int stride,
                          const InsideOf& inside_of)
        : FaceSigns(inside_of(upper), inside_of(blocks.neighbor(upper, axis_offset((axis + 1) % 3))),
                    inside_of(blocks.neighbor(upper, axis_offset((axis + 2) % 3))),
                    inside_of(blocks.neighbor(upper, axis_offset((axis + 1) % 3) + axis_offset((axis + 2) % 3))), axis,
                    stride) {}

    MENISCUS_HD BlockMask corners_any() const { return inside[0] | inside[2] | inside[6] | inside[8]; }
    MENISCUS_HD BlockMask corners_all() const { return inside[0] & inside[2] & inside[6] & inside[8]; }
    MENISCUS_HD BlockMask middles_any() const { return inside[1] | inside[3] | inside[4] | inside[5] | inside[7]; }
    MENISCUS_HD BlockMask middles_all() const { return inside[1] & inside[3] & inside[4] & inside[5] & inside[7]; }
};

}  // namespace meniscus
