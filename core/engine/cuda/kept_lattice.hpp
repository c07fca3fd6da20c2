// The lattice behind a mesh on the device: what the host has as SurfaceLattice, and what follows of it for each brick,
// so that a brick's bits have their places before anyone asks for them.
#pragma once

#include <cstdint>

#include "lattice/blocks.hpp"
#include "lattice/host_device.hpp"

namespace meniscus::cuda {

/// Counts of a brick's sections, or of their parts before a block.
struct BrickTotals {
    std::uint32_t signs = 0;    ///< corner points
    std::uint32_t middles = 0;  ///< middles of crossed coarse edges, and of their halves, that are no corners
    std::uint32_t vertices = 0;
    std::uint32_t cells = 0;  ///< cells that draw
    std::uint32_t faces = 0;  ///< outer faces that see both signs, of cells of level 2 and 3

    static constexpr unsigned count = 5;

    MENISCUS_HD BrickTotals& operator+=(const BrickTotals& other) {
        signs += other.signs;
        middles += other.middles;
        vertices += other.vertices;
        cells += other.cells;
        faces += other.faces;
        return *this;
    }
};

/// Beside each LatticeBlock: what its brick's own cells have there.
struct KeptBlock {
    BlockMask corners = 0;  ///< points that are corners of these cells
    BlockMask middles = 0;  ///< see BrickEdges
    BlockMask quarters = 0;
    EdgeMasks edges{};              ///< finest edges that carry a vertex of these cells
    BrickTotals before;             ///< of the brick's blocks before this one
    std::uint32_t outer_faces = 0;  ///< of BrickTotals::faces those of the block's cell, as bits 2 axis + side
};

/// An element for every brick of base cells.
struct KeptBrick {
    std::uint32_t first = 0;  ///< index of its first block, which lie by place
    std::uint32_t blocks = 0;
    std::uint32_t rows = 0;    ///< rows along x that hold a cell that draws
    std::uint32_t levels = 0;  ///< set of the levels of its cells, as bits
    BrickTotals totals;
};

}  // namespace meniscus::cuda
