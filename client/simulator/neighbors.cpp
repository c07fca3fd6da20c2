#include "simulator/neighbors.hpp"

#include <cmath>

namespace meniscus::simulator {

void Neighbors::find(std::span<const Vector3> positions, const CellGrid& grid, const CubicSpline& kernel,
                     float support) {
    offsets.assign(1, 0);
    offsets.reserve(positions.size() + 1);
    index.clear();
    gradient_x.clear();
    gradient_y.clear();
    gradient_z.clear();
    weight.clear();
    const float limit = support * support;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Vector3 p = positions[i];
        for (const CellGrid::Run& run : grid.around(p))
            for (std::uint32_t j = run.first; j < run.last; ++j) {
                const float dx = p[0] - positions[j][0];
                const float dy = p[1] - positions[j][1];
                const float dz = p[2] - positions[j][2];
                const float squared = dx * dx + dy * dy + dz * dz;
                if (squared >= limit || j == i) continue;
                index.push_back(j);
                weight.push_back(squared);
                gradient_x.push_back(dx);
                gradient_y.push_back(dy);
                gradient_z.push_back(dz);
            }
        offsets.push_back(index.size());
    }
    // So far distances; coincident particles have no direction to part in and get no gradient.
    constexpr float tiny = 1e-20F;
    for (std::size_t k = 0; k < weight.size(); ++k) {
        const float distance = std::sqrt(weight[k]);
        const float factor = kernel.slope(distance) / std::sqrt(weight[k] + tiny);
        weight[k] = kernel.value(distance);
        gradient_x[k] *= factor;
        gradient_y[k] *= factor;
        gradient_z[k] *= factor;
    }
}

}  // namespace meniscus::simulator
