// How much more room an array gets than it needs, so that a slowly growing flow seldom outgrows it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace meniscus {

/// elements: needed now. An eighth more.
constexpr std::uint64_t with_room_to_grow(std::uint64_t elements) {
    return elements + elements / 8;
}

/// The same for arrays that a GPU copies to and from: pinning a large one again holds up every session.
constexpr std::uint64_t with_pinned_room_to_grow(std::uint64_t elements, std::size_t element_bytes) {
    constexpr std::uint64_t large = std::uint64_t{32} << 20;  // bytes
    return elements * element_bytes > large ? elements + elements / 2 : with_room_to_grow(elements);
}

}  // namespace meniscus
