// What is numbered with 32 bits may not be more than those can tell apart.
#pragma once

#include <cstdint>
#include <string>

#include "lattice/brick_grid.hpp"
#include "meniscus/error.hpp"

namespace meniscus {

/// whose, what: as in "the surface has" and "triangles".
inline void require_numbers(std::uint64_t count, const char* whose, const char* what,
                            std::uint64_t too_many = no_index) {
    if (count >= too_many)
        throw LimitExceeded(std::string(whose) + " " + std::to_string(count) + " " + what + ", at most " +
                            std::to_string(too_many - 1) +
                            " can be numbered: use a larger cell size or fewer particles");
}

}  // namespace meniscus
