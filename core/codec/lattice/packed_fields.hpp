// The fields of the packed profile, and where they lie: one rule for the host, which writes one after the other, and
// for a device, whose threads write all at once. (proto/README.md#the-lattice-codec)
#pragma once

#include <cstdint>

#include "codec/lattice/brick_header.hpp"
#include "lattice/bits.hpp"
#include "lattice/block_mask.hpp"
#include "lattice/brick_grid.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

inline constexpr int level_bits = 2;

// Bits, below: has put(value, number of bits).

/// The signs of these points of a block.
template <class Bits>
MENISCUS_HD void put_signs(BlockMask inside, BlockMask points, Bits& bits) {
    if (points == ~BlockMask{0})
        bits.put(inside, 64);
    else if (points != 0)
        bits.put(gather_bits(inside, points), popcount(points));
}

/// A normal's field of 2 normal_bits bits. code: Octahedron::code().
MENISCUS_HD inline std::uint64_t normal_field(std::uint32_t code, int normal_bits) {
    return std::uint64_t{code & 0xFFFF} | std::uint64_t{code >> 16} << normal_bits;
}

/// How many fields a brick has.
struct PackedCounts {
    std::uint32_t rows = 0;  ///< rows of cells, of the 16 x 16 along x, that hold one that draws
    std::uint32_t cells = 0;
    bool has_one_level = false;
    std::uint32_t signs = 0;
    std::uint32_t faces = 0;    ///< outer faces of which a bit says whether a coarser cell lies beyond
    std::uint32_t middles = 0;  ///< signs of middles and quarters
    std::uint32_t vertices = 0;
};

/// Where the fields of a brick begin, in bits from that of its header.
struct PackedPlaces {
    std::uint64_t cells = 0;  ///< a slice's rows, then each of these
    std::uint64_t levels = 0;
    std::uint64_t signs = 0;
    std::uint64_t faces = 0;
    std::uint64_t edges = 0;  ///< block by block: signs of middles, of quarters, the vertices' offsets
    std::uint64_t normals = 0;
    std::uint64_t attributes = 0;  ///< from a whole byte on: the values of one after those of the other

    MENISCUS_HD PackedPlaces(const PackedCounts& of, int offset_bits, int normal_bits) {
        cells = 8 * BrickHeader::size;
        levels = cells + brick_size * (brick_size + std::uint64_t{of.rows});
        signs = levels + level_bits * std::uint64_t{of.has_one_level ? 1 : of.cells};
        faces = signs + of.signs;
        edges = faces + of.faces;
        normals = edges + of.middles + static_cast<std::uint64_t>(offset_bits) * of.vertices;
        const std::uint64_t end = normals + static_cast<std::uint64_t>(2 * normal_bits) * of.vertices;
        attributes = (end + 7) / 8 * 8;
    }
};

}  // namespace meniscus
