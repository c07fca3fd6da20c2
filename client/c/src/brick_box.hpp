// Boxes of bricks of the C interface.
#pragma once

#include <algorithm>
#include <cstdint>

#include "meniscus/brick_box.hpp"
#include "result.hpp"

namespace meniscus::c {

/// Throws InvalidInput for NULL.
inline BrickBox brick_box(const std::int32_t* lowest, const std::int32_t* highest) {
    BrickBox box;
    std::copy_n(&required(lowest, "lowest"), 3, box.lowest.begin());
    std::copy_n(&required(highest, "highest"), 3, box.highest.begin());
    return box;
}

}  // namespace meniscus::c
