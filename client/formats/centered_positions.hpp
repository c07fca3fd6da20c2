// Positions around the middle of a mesh: float32 for formats that have no other, however far away the mesh lies.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "formats/mesh_file.hpp"

namespace meniscus::formats {

struct CenteredPositions {
    std::array<double, 3> middle{};  ///< world units
    std::vector<std::array<float, 3>> positions;

    explicit CenteredPositions(const TriangleMesh& mesh) {
        for (std::size_t axis = 0; axis < 3 && !mesh.positions.empty(); ++axis) {
            const auto [low, high] =
                std::minmax_element(mesh.positions.begin(), mesh.positions.end(),
                                    [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
            middle[axis] = (*low)[axis] / 2 + (*high)[axis] / 2;
        }
        positions.reserve(mesh.positions.size());
        for (const auto& p : mesh.positions)
            positions.push_back({static_cast<float>(p[0] - middle[0]), static_cast<float>(p[1] - middle[1]),
                                 static_cast<float>(p[2] - middle[2])});
    }
};

}  // namespace meniscus::formats
