// How much more room an array gets than it needs, so that a slowly growing flow seldom outgrows it.
#pragma once

#include <cstdint>

namespace meniscus {

/// elements: needed now. An eighth more.
constexpr std::uint64_t with_room_to_grow(std::uint64_t elements) {
    return elements + elements / 8;
}

}  // namespace meniscus
