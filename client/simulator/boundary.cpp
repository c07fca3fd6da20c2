#include "simulator/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/kernel.hpp"

namespace meniscus::simulator {
namespace {

constexpr std::size_t table_size = 256;

Vector3 axis_normal(std::size_t axis, float sign) {
    Vector3 n{};
    n[axis] = sign;
    return n;
}

void push_out(Vector3& position, Vector3& velocity, const Vector3& normal, float depth) {
    if (depth <= 0.0F) return;
    const float into = std::min(0.0F, dot(velocity, normal));
    for (std::size_t a = 0; a < 3; ++a) {
        position[a] += depth * normal[a];
        velocity[a] -= into * normal[a];
    }
}

}  // namespace

Boundary::Boundary(const Tank& tank, std::optional<Sphere> obstacle, float support)
    : tank_(tank), obstacle_(obstacle), support_(support), values_(table_size + 1), slopes_(table_size + 1) {
    // area(d): the kernel's integral over the plane at distance d, 2 pi W(s) s ds from d on. The value behind the plane
    // is its integral.
    const CubicSpline kernel(support, 1.0F);
    const float step = support / static_cast<float>(table_size);
    const auto at = [&](std::size_t i) { return static_cast<float>(i) * step; };
    for (std::size_t i = table_size; i-- > 0;) {
        const float middle = at(i) + 0.5F * step;
        slopes_[i] = slopes_[i + 1] - 2.0F * std::numbers::pi_v<float> * kernel.value(middle) * middle * step;
    }
    for (std::size_t i = table_size; i-- > 0;)
        values_[i] = values_[i + 1] - 0.5F * (slopes_[i] + slopes_[i + 1]) * step;
}

void Boundary::add(BoundaryDensity& all, float distance, const Vector3& normal) const {
    if (distance >= support_) return;
    const float scaled = std::max(0.0F, distance) / support_ * static_cast<float>(table_size);
    const std::size_t i = std::min(static_cast<std::size_t>(scaled), table_size - 1);
    const float t = scaled - static_cast<float>(i);
    const float value = values_[i] + t * (values_[i + 1] - values_[i]);
    const float slope = slopes_[i] + t * (slopes_[i + 1] - slopes_[i]);
    const float free = 1.0F - all.value;
    for (std::size_t a = 0; a < 3; ++a) all.gradient[a] = all.gradient[a] * (1.0F - value) + slope * normal[a] * free;
    all.value = 1.0F - free * (1.0F - value);
}

BoundaryDensity Boundary::density(const Vector3& position) const {
    BoundaryDensity all;
    for (std::size_t a = 0; a < 3; ++a) {
        add(all, position[a], axis_normal(a, 1.0F));
        add(all, tank_.size[a] - position[a], axis_normal(a, -1.0F));
    }
    if (!obstacle_) return all;
    const Vector3 d{position[0] - obstacle_->center[0], position[1] - obstacle_->center[1],
                    position[2] - obstacle_->center[2]};
    const float length = std::sqrt(dot(d, d));
    if (length > 0.0F) add(all, length - obstacle_->radius, {d[0] / length, d[1] / length, d[2] / length});
    return all;
}

void Boundary::keep_out(Vector3& position, Vector3& velocity, float clearance) const {
    if (obstacle_) {
        const Vector3 d{position[0] - obstacle_->center[0], position[1] - obstacle_->center[1],
                        position[2] - obstacle_->center[2]};
        const float length = std::sqrt(dot(d, d));
        if (length > 0.0F)
            push_out(position, velocity, {d[0] / length, d[1] / length, d[2] / length},
                     obstacle_->radius + clearance - length);
    }
    for (std::size_t a = 0; a < 3; ++a) {
        push_out(position, velocity, axis_normal(a, 1.0F), clearance - position[a]);
        push_out(position, velocity, axis_normal(a, -1.0F), position[a] - (tank_.size[a] - clearance));
    }
}

}  // namespace meniscus::simulator
