// Positions around the middle of a mesh: float32 for formats that have no other, however far away the mesh lies.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace meniscus::files {

struct CenteredPositions {
    std::array<double, 3> middle{};  ///< world units
    std::vector<std::array<float, 3>> positions;

    /// world: world units.
    explicit CenteredPositions(std::span<const std::array<double, 3>> world) {
        for (std::size_t axis = 0; axis < 3 && !world.empty(); ++axis) {
            const auto [low, high] = std::minmax_element(
                world.begin(), world.end(), [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
            middle[axis] = (*low)[axis] / 2 + (*high)[axis] / 2;
        }
        positions.reserve(world.size());
        for (const auto& p : world)
            positions.push_back({static_cast<float>(p[0] - middle[0]), static_cast<float>(p[1] - middle[1]),
                                 static_cast<float>(p[2] - middle[2])});
    }
};

}  // namespace meniscus::files
