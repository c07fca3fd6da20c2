// The number of the next file in a folder.
#pragma once

#include <cstdint>

namespace meniscus::server {

/// A number from 1 that is free, by `taken`. Where numbers were taken in order, it is the one after them. Asks
/// twice for each bit of it, and so finds the millionth file as soon as the tenth.
template <class Taken>
std::uint32_t free_number(const Taken& taken) {
    std::uint32_t below = 0;
    std::uint32_t free = 1;
    while (taken(free)) {
        below = free;
        free *= 2;
    }
    while (free - below > 1) {
        const std::uint32_t middle = below + (free - below) / 2;
        (taken(middle) ? below : free) = middle;
    }
    return free;
}

}  // namespace meniscus::server
