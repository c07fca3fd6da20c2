// Every pair of particles within the kernel's support, with the kernel evaluated once for all passes of a step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simulator/cell_grid.hpp"
#include "simulator/kernel.hpp"

namespace meniscus::simulator {

struct Neighbors {
    std::vector<std::size_t> offsets;  ///< particle i's pairs are offsets[i] ... offsets[i + 1]
    std::vector<std::uint32_t> index;  ///< the other particle
    std::vector<float> weight;         ///< kernel value
    std::vector<float> gradient_x;     ///< gradient by particle i's position
    std::vector<float> gradient_y;
    std::vector<float> gradient_z;

    /// positions: in the order of the grid's last sort.
    void find(std::span<const Vector3> positions, const CellGrid& grid, const CubicSpline& kernel, float support);
};

}  // namespace meniscus::simulator
