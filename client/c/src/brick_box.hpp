// Boxes of bricks of the C interface.
#pragma once

#include <algorithm>
#include <cstdint>

#include "meniscus/brick_box.hpp"
#include "result.hpp"

namespace meniscus::c {

/// Throws InvalidInput for NULL, and as bricks_between() does.
inline BrickBox brick_box(const std::int32_t* lowest, const std::int32_t* highest) {
    BrickCoordinate first{}, last{};
    std::copy_n(&required(lowest, "lowest"), first.size(), first.begin());
    std::copy_n(&required(highest, "highest"), last.size(), last.begin());
    return bricks_between(first, last);
}

}  // namespace meniscus::c
