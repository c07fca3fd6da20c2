#include "picture/camera.hpp"

#include <limits>
#include <numbers>

namespace meniscus::cli {
namespace {

/// Viewer's distance in radii of the bounding sphere: a mild perspective.
constexpr double distance_in_radii = 3.5;

double dot(const Vector3& a, const Vector3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

Camera::Camera(std::span<const Vector3> points, UpAxis up, double azimuth, double elevation, std::size_t width,
               std::size_t height, double margin) {
    const double a = azimuth * std::numbers::pi / 180.0;
    const double e = elevation * std::numbers::pi / 180.0;
    axes_ = {{{std::cos(a), 0.0, -std::sin(a)},
              {-std::sin(a) * std::sin(e), std::cos(e), -std::cos(a) * std::sin(e)},
              {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)}}};
    if (up == UpAxis::z)
        for (Vector3& axis : axes_) axis = {axis[0], -axis[2], axis[1]};

    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vector3 low{infinity, infinity, infinity};
    Vector3 high{-infinity, -infinity, -infinity};
    for (const Vector3& p : points)
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], p[i]);
            high[i] = std::max(high[i], p[i]);
        }
    if (points.empty()) return;
    for (std::size_t i = 0; i < 3; ++i) center_[i] = 0.5 * (low[i] + high[i]);
    const double radius = 0.5 * std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    if (radius > 0.0) distance_ = distance_in_radii * radius;

    // With scale 1 and no offset, find the rectangle that the points cover, and fit it.
    double left = infinity;
    double right = -infinity;
    double top = infinity;
    double bottom = -infinity;
    for (const Vector3& p : points) {
        const Vector3 v = view(p);
        left = std::min(left, v[0] / v[2]);
        right = std::max(right, v[0] / v[2]);
        top = std::min(top, -v[1] / v[2]);
        bottom = std::max(bottom, -v[1] / v[2]);
    }
    const auto w = static_cast<double>(width);
    const auto h = static_cast<double>(height);
    const double free = 1.0 - 2.0 * margin;
    scale_ = std::min(w * free / std::max(right - left, 1e-9), h * free / std::max(bottom - top, 1e-9));
    offset_x_ = 0.5 * w - scale_ * 0.5 * (left + right);
    offset_y_ = 0.5 * h - scale_ * 0.5 * (top + bottom);
}

Vector3 Camera::view(const Vector3& point) const {
    const Vector3 d{point[0] - center_[0], point[1] - center_[1], point[2] - center_[2]};
    return {dot(d, axes_[0]), dot(d, axes_[1]), distance_ - dot(d, axes_[2])};
}

ScreenPoint Camera::project(const Vector3& point) const {
    const Vector3 v = view(point);
    return {static_cast<float>(offset_x_ + scale_ * v[0] / v[2]), static_cast<float>(offset_y_ - scale_ * v[1] / v[2]),
            static_cast<float>(v[2] / distance_)};
}

std::array<float, 3> Camera::turn(const std::array<float, 3>& direction) const {
    const Vector3 d{static_cast<double>(direction[0]), static_cast<double>(direction[1]),
                    static_cast<double>(direction[2])};
    return {static_cast<float>(dot(d, axes_[0])), static_cast<float>(dot(d, axes_[1])),
            static_cast<float>(dot(d, axes_[2]))};
}

}  // namespace meniscus::cli
