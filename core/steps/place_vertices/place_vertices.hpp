// Step 6: which finest lattice edges carry a vertex, its number, and its place on the edge.
//
// An edge point's identity is a finest lattice edge: from a coarse edge, go to the half whose ends differ in sign until
// the edge is c long. Cells of different levels thereby name the same vertex. (The paper's Step 6, Algorithm 2;
// core/README.md#step-6-place-vertices)
#pragma once

#include <cstdint>

#include "field/lanes.hpp"
#include "lattice/blocks.hpp"
#include "lattice/host_device.hpp"
#include "lattice/levels_around.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus {

/// Lower ends of a block's edges along an axis that cells of the band of this level use. A cell of level 3 uses all of
/// its block's finest edges, among them those that longer edges come down to.
MENISCUS_HD inline BlockMask used_edges(const LevelsAround& around, int axis, int level) {
    const BlockMask points = stride_points(level_stride(level));
    if (around.own_is_finest()) return level == 3 ? points : 0;
    const int cells = around.at_least[level] & ~around.at_least[level + 1];
    const int u = lateral_u(axis);
    const int v = lateral_v(axis);
    const auto of_cell = [cells](int down, BlockMask edges) { return (cells >> down & 1) != 0 ? edges : 0; };
    return of_cell(0, points) | of_cell(1 << u, points & low_face(u)) | of_cell(1 << v, points & low_face(v)) |
           of_cell(1 << u | 1 << v, points & low_face(u) & low_face(v));
}

/// The edges of a block along one axis that a cell of the band uses and that cross the surface, by their length in
/// finest cells, as masks of their lower ends.
struct CrossedEdges {
    BlockMask length4 = 0, length2 = 0, length1 = 0;
    BlockMask change1 = 0, change2 = 0;  ///< points whose sign differs one and two points further
    int axis = 0;

    MENISCUS_HD CrossedEdges(const BlocksView& blocks, std::uint32_t block, const LevelsAround& around, int along)
        : CrossedEdges(blocks.inside[block], blocks.inside_or_none(blocks.neighbor(block, axis_offset(along))), around,
                       along) {}
    /// own, next: signs of the block and of the next one up the axis.
    MENISCUS_HD CrossedEdges(BlockMask own, BlockMask next, const LevelsAround& around, int along) : axis(along) {
        if (own == next && (own == 0 || own == ~BlockMask{0})) return;
        look_at(own, next);
        length4 = used_edges(around, axis, 1) & (own ^ next);
        length2 = used_edges(around, axis, 2) & change2;
        length1 = used_edges(around, axis, 3) & change1;
    }
    /// Looks again at the signs, of which some middles' may have come.
    MENISCUS_HD void look_at(BlockMask own, BlockMask next) {
        change1 = own ^ shifted(own, next, axis, 1);
        change2 = own ^ shifted(own, next, axis, 2);
    }
    /// Edges of length 2 and the halves of longer ones; needs the middles of those sampled.
    MENISCUS_HD BlockMask length2_all() const {
        const BlockMask lower = length4 & change2;
        return length2 | lower | (length4 & ~lower) << (2 * bit_step(axis));
    }
    /// The finest edges; needs all middles sampled.
    MENISCUS_HD BlockMask finest() const {
        const BlockMask halves = length2_all();
        const BlockMask lower = halves & change1;
        return length1 | lower | (halves & ~lower) << bit_step(axis);
    }
};

/// Number of the vertex on a block's finest edge along an axis, from a point.
MENISCUS_HD inline std::uint32_t vertex_number(const BlocksView& blocks, std::uint32_t block, int axis, int bit) {
    const EdgeMasks& edges = blocks.edges[block];
    int before = popcount(edges.axis[axis] & ((BlockMask{1} << bit) - 1));
    for (int earlier = 0; earlier < axis; ++earlier) before += popcount(edges.axis[earlier]);
    return blocks.first_vertex[block] + static_cast<std::uint32_t>(before);
}

/// Number of the vertex on the edge of this stride that starts at a point of a closed cell (coordinates 0 to 4) and
/// crosses the surface.
MENISCUS_HD inline std::uint32_t vertex_on_edge(const BlocksView& blocks, const ClosedCell& cell, int x, int y, int z,
                                                int axis, int stride) {
    const std::uint32_t block = cell.owner(x, y, z);
    int bit = ClosedCell::bit(x, y, z);
    for (int half = stride / 2 * bit_step(axis); half >= bit_step(axis); half /= 2)
        if (((blocks.inside[block] >> bit ^ blocks.inside[block] >> (bit + half)) & 1) == 0) bit += half;
    return vertex_number(blocks, block, axis, bit);
}

/// The field values of a block's sampled points; zero where no block is stored.
struct SampledValues {
    const BlocksView& blocks;
    std::uint32_t block;
    MENISCUS_HD float operator()(int bit) const { return block == no_index ? 0.0F : blocks.value(block, bit); }
};

/// The field values at the ends of a finest edge.
struct EdgeValues {
    float low, high;
    /// Whether the domain's border, not the field, makes the outer end outside.
    MENISCUS_HD bool cropped(float iso) const { return (low > iso) == (high > iso); }
};

/// The values at the ends of an edge. own, next: from a point's bit to its value, in the edge's block and in the
/// neighbor up the axis.
template <class Values>
MENISCUS_HD inline EdgeValues edge_values(const Values& own, const Values& next, int axis, int bit) {
    return {own(bit), point_coordinate(bit, axis) < 3 ? own(bit + bit_step(axis)) : next(bit - 3 * bit_step(axis))};
}

/// Place of the vertex on a finest edge between field values `low` and `high`, on both sides of the iso-value, by
/// linear interpolation: in steps of c / 2^bits, 1 to 2^bits - 1. iso: need not lie between them. F is float or Lanes.
template <class F>
MENISCUS_HD inline F interpolated_offset(F low, F high, F iso, int bits) {
    const F t = (iso - low) / (high - low);
    const F half_steps = trunc(t * F(static_cast<float>(2 << bits))) + F(1.0F);
    const F nearest = trunc(half_steps * F(0.5F));
    return max(min(nearest, F(static_cast<float>((1 << bits) - 1))), F(1.0F));
}

/// The paper's bisection, in steps of c / 2^bits: the first point tried on a finest edge is its middle. The halves of
/// coarse edges have been chosen by the samples already.
MENISCUS_HD inline float bisection_start(int bits) {
    return static_cast<float>(1 << (bits - 1));
}
/// The distance of the second point from the first; each further point is half as far from the last, down to 1.
MENISCUS_HD inline int first_bisection_step(int bits) {
    return (1 << bits) / 4;
}
/// The next point: the middle of the half that still has a change of sign. inside: whether the last point is.
MENISCUS_HD inline float bisected_offset(float offset, int step, bool inside, bool low_inside) {
    return offset + static_cast<float>(inside == low_inside ? step : -step);
}

/// A point in units from a base cell's corner, a whole number of steps of c / 2^bits, on the refined lattice.
MENISCUS_HD inline LatticePosition lattice_position(const Int3& base_cell, int bits, float x, float y, float z) {
    const int steps_per_base_cell = base_cell_size << bits;
    const float steps_per_unit = 1.0F / static_cast<float>(units_per_cell >> bits);
    return {base_cell.x * steps_per_base_cell + static_cast<int>(x * steps_per_unit),
            base_cell.y * steps_per_base_cell + static_cast<int>(y * steps_per_unit),
            base_cell.z * steps_per_base_cell + static_cast<int>(z * steps_per_unit)};
}

/// The field's normal, or along the edge where the domain's border or a vanishing gradient leaves none.
MENISCUS_HD inline Normal outward_normal(const Normal& of_field, bool cropped, int axis, bool low_inside) {
    const float sum = of_field[0] + of_field[1] + of_field[2];
    if (sum - sum == 0.0F && !cropped) return of_field;  // finite
    const float along = low_inside ? 1.0F : -1.0F;
    return {axis == 0 ? along : 0.0F, axis == 1 ? along : 0.0F, axis == 2 ? along : 0.0F};
}

/// A cropped edge has its vertex next to the border.
MENISCUS_HD inline float cropped_offset(bool low_inside, int bits) {
    return static_cast<float>(low_inside ? (1 << bits) - 1 : 1);
}

}  // namespace meniscus
