// From the world to the screen.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "picture/rasterizer.hpp"

namespace meniscus::cli {

using Vector3 = std::array<double, 3>;

enum class UpAxis { y, z };
constexpr std::string_view name_of(UpAxis axis) {
    switch (axis) {
        case UpAxis::y:
            return "y";
        case UpAxis::z:
            return "z";
    }
    return {};
}

/// Looks at a cloud of points from a direction, in perspective, so that they fill the picture.
class Camera {
public:
    /// azimuth, elevation: where the viewer stands, degrees; (0, 0) is on the axis that points out of the screen when
    /// up points up and x to the right. margin: part of the picture left free on each side.
    Camera(std::span<const Vector3> points, UpAxis up, double azimuth, double elevation, std::size_t width,
           std::size_t height, double margin = 0.05);

    ScreenPoint project(const Vector3& point) const;
    /// A direction in view space: x to the right, y up, z towards the viewer.
    std::array<float, 3> turn(const std::array<float, 3>& direction) const;

private:
    Vector3 view(const Vector3& point) const;

    std::array<Vector3, 3> axes_{};  ///< right, up, towards the viewer, in world space
    Vector3 center_{};
    double distance_ = 1.0;
    double scale_ = 1.0;
    double offset_x_ = 0.0;
    double offset_y_ = 0.0;
};

}  // namespace meniscus::cli
