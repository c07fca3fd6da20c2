// What a triangle adds to the normals of its corners: the rule by which receivers compute normals, and the entropy
// profile predicts them.
#pragma once

#include <array>
#include <cstddef>

#include "meniscus/mesh.hpp"

namespace meniscus {

/// Calls add(i, part) for each corner i of a triangle: its normal, weighted by 1 / (|e|^2 |g|^2) of the two sides at
/// the corner (Max 1999: Weights for computing vertex normals from facet normals). So no part is longer than 1 / (|e|
/// |g|). Nothing for a triangle that has two corners in one place. All operations are exact or rounded once.
template <class Real, class Add>
inline void add_corner_normals(const std::array<LatticePosition, 3>& corners, const Add& add) {
    using Vector = std::array<Real, 3>;
    const auto square = [](const Vector& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; };
    std::array<Vector, 3> side;  // from corner i to the next
    std::array<Real, 3> length;  // squared
    for (std::size_t i = 0; i < 3; ++i) {
        const LatticePosition& from = corners[i];
        const LatticePosition& to = corners[(i + 1) % 3];
        for (std::size_t k = 0; k < 3; ++k) side[i][k] = static_cast<Real>(to[k] - from[k]);
        length[i] = square(side[i]);
        if (length[i] == Real{0}) return;
    }
    const Vector normal{side[0][1] * side[1][2] - side[0][2] * side[1][1],
                        side[0][2] * side[1][0] - side[0][0] * side[1][2],
                        side[0][0] * side[1][1] - side[0][1] * side[1][0]};
    for (std::size_t i = 0; i < 3; ++i) {
        const Real weight = Real{1} / (length[i] * length[(i + 2) % 3]);
        add(i, Vector{normal[0] * weight, normal[1] * weight, normal[2] * weight});
    }
}

}  // namespace meniscus
