// A vertex on a coarser lattice, so that it takes fewer bits.
#pragma once

#include <algorithm>
#include <cstdint>

namespace meniscus {

/// One coordinate from steps of c / 2^from to the nearest step of c / 2^to; 2 <= to <= from. A vertex lies inside of a
/// finest lattice edge, of which no other vertex has a share. It stays inside: no two vertices ever meet, so a closed
/// mesh stays closed, and a point in a lattice plane or beside it stays so.
inline std::uint16_t round_position(std::uint16_t position, std::uint32_t from, std::uint32_t to) {
    const std::uint32_t dropped = from - to;
    const std::uint32_t offset = position & ((1U << from) - 1);
    if (dropped == 0 || offset == 0) return static_cast<std::uint16_t>(position >> dropped);
    const std::uint32_t nearest = (offset + (1U << (dropped - 1))) >> dropped;
    const std::uint32_t inside = std::clamp(nearest, 1U, (1U << to) - 1);
    return static_cast<std::uint16_t>((std::uint32_t{position} >> from << to) + inside);
}

}  // namespace meniscus
