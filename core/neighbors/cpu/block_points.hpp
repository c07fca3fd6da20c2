// A block's lattice points in units from its corner, by bit.
#pragma once

#include "lattice/block_mask.hpp"
#include "lattice/coordinates.hpp"

namespace meniscus::cpu {

struct BlockPoints {
    float coordinate[3][64];
};

inline constexpr BlockPoints block_points = [] {
    BlockPoints points{};
    for (int axis = 0; axis < 3; ++axis)
        for (int bit = 0; bit < 64; ++bit)
            points.coordinate[axis][bit] = static_cast<float>(point_coordinate(bit, axis) * units_per_cell);
    return points;
}();

}  // namespace meniscus::cpu
