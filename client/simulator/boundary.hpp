// The solid walls around the water and the obstacle in it.
#pragma once

#include <optional>
#include <vector>

#include "simulator/vector3.hpp"

namespace meniscus::simulator {

/// Box from the origin to `size`, meters; y is up.
struct Tank {
    Vector3 size{};
};

struct Sphere {
    Vector3 center{};
    float radius = 0.0F;
};

/// What the solids add to a particle's density, relative to the rest density, and its gradient there.
struct BoundaryDensity {
    float value = 0.0F;
    Vector3 gradient{};
};

/// A solid acts as if it were filled with fluid at rest: it adds the kernel's integral over the half-space behind its
/// surface (a sphere is flat at the scale of the kernel). No boundary particles: nothing to sample, and walls without
/// bumps. Where solids meet, the free parts that they leave multiply, as they do at a right-angled edge.
class Boundary {
public:
    /// support: the kernel's, meters.
    Boundary(const Tank& tank, std::optional<Sphere> obstacle, float support);

    const Tank& tank() const { return tank_; }
    const std::optional<Sphere>& obstacle() const { return obstacle_; }

    BoundaryDensity density(const Vector3& position) const;
    /// Moves a particle that is nearer to a solid than `clearance` away and takes the velocity into the solid from it:
    /// the last resort behind the pressure.
    void keep_out(Vector3& position, Vector3& velocity, float clearance) const;

private:
    void add(BoundaryDensity& all, float distance, const Vector3& normal) const;

    Tank tank_;
    std::optional<Sphere> obstacle_;
    float support_;
    std::vector<float> values_;  ///< by distance, from 0 to the support
    std::vector<float> slopes_;
};

}  // namespace meniscus::simulator
