// Particles sorted by cells, so that the neighbors of one lie in a few contiguous runs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "simulator/vector3.hpp"

namespace meniscus::simulator {

/// Cubic cells over a box from the origin to `size`; what lies outside counts to the nearest cell.
class CellGrid {
public:
    CellGrid(const Vector3& size, float cell);

    /// The order that sorts the positions by cell (x fastest), stable; the runs refer to that order.
    const std::vector<std::uint32_t>& sort(std::span<const Vector3> positions);

    struct Run {
        std::uint32_t first = 0;
        std::uint32_t last = 0;  ///< exclusive
    };
    /// The sorted particles in the 3 x 3 x 3 cells around `position`, as nine runs.
    std::array<Run, 9> around(const Vector3& position) const;

private:
    std::array<std::int32_t, 3> cell_of(const Vector3& position) const;
    std::size_t index(std::int32_t x, std::int32_t y, std::int32_t z) const;

    float inverse_cell_;
    std::array<std::int32_t, 3> count_{};
    std::vector<std::uint32_t> starts_;  ///< of each cell's particles, and the end
    std::vector<std::uint32_t> cells_;   ///< of each particle
    std::vector<std::uint32_t> order_;
};

}  // namespace meniscus::simulator
