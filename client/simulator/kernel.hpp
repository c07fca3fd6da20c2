// The cubic spline of SPH, as a polynomial without branches.
#pragma once

#include <algorithm>
#include <numbers>

namespace meniscus::simulator {

/// A kernel of integral `mass` over a ball of radius `support` (twice the smoothing length).
class CubicSpline {
public:
    CubicSpline(float support, float mass)
        : inverse_(1.0F / support), norm_(8.0F * mass / (std::numbers::pi_v<float> * support * support * support)) {}

    float value(float distance) const {
        const float q = distance * inverse_;
        const float a = std::max(1.0F - q, 0.0F);
        const float b = std::max(0.5F - q, 0.0F);
        return norm_ * (2.0F * a * a * a - 8.0F * b * b * b);
    }
    /// Derivative by the distance: negative or zero.
    float slope(float distance) const {
        const float q = distance * inverse_;
        const float a = std::max(1.0F - q, 0.0F);
        const float b = std::max(0.5F - q, 0.0F);
        return norm_ * inverse_ * (24.0F * b * b - 6.0F * a * a);
    }

private:
    float inverse_;
    float norm_;
};

}  // namespace meniscus::simulator
