// What is numbered with 32 bits may not be more than those can tell apart.
#pragma once

#include <cstdint>
#include <string>

#include "lattice/brick_grid.hpp"
#include "meniscus/error.hpp"

namespace meniscus {

/// whose, what: as in "the surface has" and "triangles".
inline void require_numbers(std::uint64_t count, const char* whose, const char* what) {
    if (count >= no_index)
        throw LimitExceeded(std::string(whose) + " more than " + std::to_string(no_index) + " " + what +
                            ", more than can be numbered: use a larger cell size or fewer particles");
}

}  // namespace meniscus
