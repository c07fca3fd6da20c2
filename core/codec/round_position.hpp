// A vertex on a coarser lattice, so that it takes fewer bits.
#pragma once

#include <cstdint>

#include "lattice/host_device.hpp"

namespace meniscus {

/// One coordinate from steps of c / 2^from to the nearest step of c / 2^to; 2 <= to <= from. A vertex lies inside of a
/// finest lattice edge, of which no other vertex has a share. It stays inside: no two vertices ever meet, so a closed
/// mesh stays closed, and a point in a lattice plane or beside it stays so.
MENISCUS_HD inline std::uint16_t round_position(std::uint16_t position, std::uint32_t from, std::uint32_t to) {
    const std::uint32_t dropped = from - to;
    const std::uint32_t offset = position & ((1U << from) - 1);
    if (dropped == 0 || offset == 0) return static_cast<std::uint16_t>(position >> dropped);
    const std::uint32_t nearest = (offset + (1U << (dropped - 1))) >> dropped;
    const std::uint32_t last = (1U << to) - 1;
    const std::uint32_t inside = nearest < 1 ? 1 : nearest > last ? last : nearest;
    return static_cast<std::uint16_t>((std::uint32_t{position} >> from << to) + inside);
}

/// The place of a vertex on its finest edge, in steps of c / 2^to. coordinate: of its position along that edge, in
/// steps of c / 2^from.
MENISCUS_HD inline std::uint8_t edge_offset(std::int32_t coordinate, std::uint32_t from, int to) {
    const std::uint32_t within_edge = static_cast<std::uint32_t>(coordinate) & ((1U << from) - 1);
    return static_cast<std::uint8_t>(
        round_position(static_cast<std::uint16_t>(within_edge), from, static_cast<std::uint32_t>(to)));
}

}  // namespace meniscus
