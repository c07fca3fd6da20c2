// Step 2: the level that every base cell asks for, and the band of cells that the surface may pass. (The paper's Step
// 2, Algorithm 1; core/README.md#the-criterion)
#pragma once

#include <cstdint>

#include "engine/block_state.hpp"
#include "field/lanes.hpp"
#include "lattice/blocks.hpp"
#include "lattice/cell_set.hpp"
#include "lattice/host_device.hpp"
#include "meniscus/settings.hpp"
#include "steps/split_cells/curvature.hpp"

namespace meniscus {

// The rule of a criterion is a callable from a block to its level, 1 to 3. It is asked when the band is known and
// levels are not: a block's level is 0 outside of the band.

/// CountCriterion's rule: few particles in a cell are a splash, which needs the finest level.
struct CountRule {
    const std::uint32_t* counts = nullptr;  ///< particles per block; adaptive SPH: those of level 0
    std::uint32_t threshold = 1;
    bool adaptive_sph = false;

    MENISCUS_HD int operator()(const BlocksView&, std::uint32_t block) const {
        const std::uint32_t count = counts[block];
        const bool fine = adaptive_sph ? count >= threshold : count >= 1 && count <= threshold;
        return fine ? 3 : 1;
    }
};

/// Marching cubes at the finest cell: the baseline.
struct UniformRule {
    MENISCUS_HD int operator()(const BlocksView&, std::uint32_t) const { return 3; }
};

/// CurvatureCriterion's rule. A face of edge s that is blended between its corners departs from a surface of principal
/// curvatures k and m by (|k| + |m|) s^2 / 12 in the mean, which may be at most `tolerance` cells. A cell bends at
/// least half as much as its face neighbors, so that levels do not fall off faster than the surface calms (half:
/// core/README.md#neighbors-05-and-05).
struct CurvatureRule {
    const CellBend* cells = nullptr;  ///< per block
    float tolerance = 0.0F;           ///< largest departure, in cells

    MENISCUS_HD int operator()(const BlocksView& blocks, std::uint32_t block) const {
        int level = of_curvature(cells[block].curvature);
        for (int axis = 0; axis < 3; ++axis)
            for (int side = -1; side <= 1; side += 2) {
                const std::uint32_t other = blocks.neighbor(block, axis_offset(axis, side));
                if (other != no_index) level = max_level(level, of_neighbor(cells[other]));
            }
        // A cell that joins the band later holds surface that its corners do not show.
        return max_level(level, blocks.level[block] == 0 ? 2 : cells[block].least_level);
    }

    // Its parts, for rules that look at 64 cells at once.

    /// The level that a cell's own surface asks for.
    MENISCUS_HD int of_cell(const CellBend& cell) const {
        return max_level(of_curvature(cell.curvature), cell.least_level);
    }
    /// The level that a cell asks of its face neighbors.
    MENISCUS_HD int of_neighbor(const CellBend& cell) const { return of_curvature(0.5F * cell.curvature); }

private:
    MENISCUS_HD int of_curvature(float curvature) const {
        return curvature * 4.0F <= 3.0F * tolerance ? 1 : curvature <= 3.0F * tolerance ? 2 : 3;
    }
    MENISCUS_HD static int max_level(int a, int b) { return a > b ? a : b; }
};

/// Drops that no corner shows: a cell whose corners are all outside, but with a particle so near that its own blob may
/// reach in (core/README.md#drops-025-and-017).
struct BlobRule {
    float closest = 0.75F;  ///< threshold of CellReach::closest
    int level = 2;          ///< 3 where the finest cells are large against the support

    MENISCUS_HD int least_level(int inside_corners, const CellReach& reach) const {
        return inside_corners == 0 && reach.closest >= closest ? level : 1;
    }
};

MENISCUS_HD inline bool is_mixed(int inside_corners) {
    return inside_corners != 0 && inside_corners != 8;
}

/// A surface this near outside of a cell bends for the cell's neighbors, whose own search may meet a calmer part of it
/// (measured: core/README.md#neighbors-05-and-05). Units.
inline constexpr float surface_margin = 0.5F * units_per_cell;

/// Combines the search for a cell's surface with the level that its particles ask for (BlobRule).
MENISCUS_HD inline CellBend cell_bend(const SurfaceSearch<float>& search, int inside_corners, int blob_level) {
    const bool agree = !is_mixed(inside_corners);
    const bool hidden = agree && search.inside >= 0.0F;
    const bool touched = search.inside >= -surface_margin;
    const int least_level = hidden && blob_level < 2 ? 2 : blob_level;
    if (agree && !touched) return {0.0F, 0.0F, least_level};
    constexpr auto c = static_cast<float>(units_per_cell);
    return {search.bend.curvature * c, search.bend.trace * (c * c), least_level};
}

struct BandTest {
    float iso = 0.0F;
    /// Corner values above this mean that nothing of the surface is inside the cell; found by experiment for the color
    /// field (core/README.md#the-band-085), infinite for the others.
    float deep_inside = 0.0F;

    MENISCUS_HD bool is_deep(float value) const { return value > deep_inside; }
    /// bound: no field value in the cell is above this, rounding aside (core/README.md#the-bound-09999).
    MENISCUS_HD bool may_reach(float bound) const { return bound > iso * 0.9999F; }
};

/// Base vertices as sets of the cells whose lowest corner they are.
struct BaseVertexSets {
    CellSetView inside;
    CellSetView deep;  ///< vertices inside that are deep, see BandTest
};

/// The base vertices at the corners of the 64 cells of a word.
struct CornerSets {
    std::uint64_t any_inside = 0;
    std::uint64_t all_deep = ~std::uint64_t{0};

    CornerSets() = default;
    MENISCUS_HD CornerSets(const BaseVertexSets& vertices, std::uint32_t brick, int w) {
        for (int i = 0; i < 8; ++i) {
            const Int3 corner{i & 1, i >> 1 & 1, i >> 2};
            any_inside |= vertices.inside.moved(brick, w, corner);
            all_deep &= vertices.deep.moved(brick, w, corner);
        }
    }
    /// bound: no field value in the cell is above this.
    MENISCUS_HD bool may_hold_surface(int bit, const BandTest& test, float bound) const {
        return (any_inside >> bit & 1) != 0 ? (all_deep >> bit & 1) == 0 : test.may_reach(bound);
    }
};

}  // namespace meniscus
