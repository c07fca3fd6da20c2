// Elements that have 32-bit indices: their number is limited.
#pragma once

#include <cstdint>
#include <string>

#include "lattice/brick_grid.hpp"
#include "meniscus/error.hpp"

namespace meniscus {

/// Throws LimitExceeded where `count` elements would need larger indices. subject, elements: the message's words, as in
/// "the surface has" and "triangles".
inline void require_indexable(std::uint64_t count, const char* subject, const char* elements,
                              std::uint64_t too_many = no_index) {
    if (count >= too_many)
        throw LimitExceeded(std::string(subject) + " " + std::to_string(count) + " " + elements + ", at most " +
                            std::to_string(too_many - 1) +
                            " can be numbered: use a larger cell size or fewer particles");
}

}  // namespace meniscus
