// What the lattice coder takes in scratch memory.
#pragma once

#include <cstddef>

#include "meniscus/brick_coding.hpp"

namespace meniscus {

/// Charges the scratch memory's account for a brick of a lattice codec. Throws LimitExceeded if that would pass its
/// limit.
inline void charge_for(std::size_t vertices, BrickScratch& scratch) {
    constexpr std::size_t coder_bytes = std::size_t{3} << 20;
    constexpr std::size_t bytes_a_vertex = 128;
    const std::size_t bytes = coder_bytes + bytes_a_vertex * vertices;
    Array<std::byte>& charged = scratch.charge;
    if (charged.capacity() >= bytes) return;
    charged = Array<std::byte>(charged.get_allocator());  // gives the smaller one back first
    charged.reserve(bytes);
}

}  // namespace meniscus
