// Three floats.
#pragma once

#include <array>

namespace meniscus::simulator {

using Vector3 = std::array<float, 3>;

inline float dot(const Vector3& a, const Vector3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace meniscus::simulator
