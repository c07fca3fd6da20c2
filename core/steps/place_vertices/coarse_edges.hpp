// Half a sagitta. The corners of a coarse triangle lie on the surface, so that all of it lies on the hollow side. Its
// vertices are moved out by half of that (core/README.md#half-a-sagitta-005).
#pragma once

#include <cstdint>

#include "lattice/blocks.hpp"
#include "lattice/cell_bend.hpp"
#include "lattice/host_device.hpp"
#include "lattice/levels_around.hpp"

namespace meniscus {

/// Share of the departure s^2 tr that vertices are moved by.
inline constexpr float half_sagitta = 0.05F;

/// The part of a cell that its edges need.
struct CellAtEdge {
    int level = 0;
    float trace = 0.0F;  ///< see CellBend

    CellAtEdge() = default;
    /// bends: of every block.
    MENISCUS_HD CellAtEdge(const BlocksView& blocks, const CellBend* bends, std::uint32_t block)
        : level(blocks.level_or_none(block)), trace(level == 0 ? 0.0F : bends[block].trace) {}
};

/// The difference from the iso-value that the vertex on an edge takes; 0 where a cell of level 3 has the edge, or none
/// of its cells found surface. bit: the edge's lower end in its block. cell: from an index of LevelsAround to the
/// CellAtEdge there.
template <class Cell>
MENISCUS_HD inline float iso_shift(int axis, int bit, const Cell& cell) {
    const int u = lateral_u(axis);
    const int v = lateral_v(axis);
    const bool is_low[2] = {point_coordinate(bit, u) == 0, point_coordinate(bit, v) == 0};
    int highest = 0;
    int found = 0;
    float traces = 0.0F;
    for (int i = 0; i < 4; ++i) {
        if (((i & 1) != 0 && !is_low[0]) || ((i & 2) != 0 && !is_low[1])) continue;
        const CellAtEdge at = cell((i & 1) << u | (i >> 1) << v);
        highest = at.level > highest ? at.level : highest;
        traces += at.trace;
        found += at.trace != 0.0F ? 1 : 0;
    }
    if (highest == 3 || found == 0) return 0.0F;
    const auto edge = static_cast<float>(level_stride(highest));
    return half_sagitta * edge * edge * (traces / static_cast<float>(found));
}

}  // namespace meniscus
