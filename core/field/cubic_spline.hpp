// The kernel of the fields color and density: Monaghan's cubic spline (1992) of compact support h, in the form without
// a branch, W(q) / W0 = max(1 - q, 0)^3 - 4 max(1/2 - q, 0)^3, q = distance / h, W0 = 16 / (pi h^3).
#pragma once

#include <cmath>
#include <cstddef>

#include "field/jet.hpp"
#include "field/lanes.hpp"
#include "field/neighbor_view.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// F is float or Lanes. q >= 0.
template <class F>
MENISCUS_HD inline F cubic_spline(F q) {
    const F a = max(F(1.0F) - q, F(0.0F));
    const F b = max(F(0.5F) - q, F(0.0F));
    const F b2 = b + b;
    return fnma(b2 * b2, b, a * (a * a));
}

/// Derivative of cubic_spline by q.
template <class F>
MENISCUS_HD inline F cubic_spline_derivative(F q) {
    const F a = max(F(1.0F) - q, F(0.0F));
    const F b = max(F(0.5F) - q, F(0.0F));
    return fma(F(12.0F) * b, b, F(-3.0F) * (a * a));
}

/// Second derivative of cubic_spline by q.
template <class F>
MENISCUS_HD inline F cubic_spline_second_derivative(F q) {
    const F a = max(F(1.0F) - q, F(0.0F));
    const F b = max(F(0.5F) - q, F(0.0F));
    return fma(F(-24.0F), b, F(6.0F) * a);
}

/// 1 / h, not rounded below, so that the kernel is exactly zero from a distance of h on.
inline float inverse_support(float support) {
    const float inverse = 1.0F / support;
    return fma(inverse, support, -1.0F) < 0.0F ? std::nextafter(inverse, 1.0F) : inverse;
}

template <class F>
MENISCUS_HD inline F length(F dx, F dy, F dz) {
    return sqrt(fma(dx, dx, fma(dy, dy, dz * dz)));
}

/// One particle's share in a field. Distances in units.
struct CubicSpline {
    static constexpr bool has_own_support = false;

    float weight;  ///< mass (over density) times W0
    float inverse_support;

    MENISCUS_HD static CubicSpline of(const NeighborView& near, std::size_t j) {
        return {near.weight[j], near.inverse_support};
    }

    template <class F>
    MENISCUS_HD F share(F dx, F dy, F dz) const {
        return F(weight) * cubic_spline(length(dx, dy, dz) * F(inverse_support));
    }

    /// The strength, of which add_strength() makes a share: W(q) / W0.
    template <class F>
    MENISCUS_HD F strength(F dx, F dy, F dz) const {
        return cubic_spline(length(dx, dy, dz) * F(inverse_support));
    }
    template <class F>
    MENISCUS_HD F add_strength(F sum, F s) const {
        return fma(F(weight), s, sum);
    }
    /// Adds the share to the value.
    template <class F>
    MENISCUS_HD F add_value(F sum, F dx, F dy, F dz) const {
        return add_strength(sum, strength(dx, dy, dz));
    }

    /// The same for an upper bound, by the distance from a box. `closest` becomes the largest 1 - distance/h.
    template <class F>
    MENISCUS_HD void add_bound(F& sum, F& closest, F dx, F dy, F dz, float) const {
        const F q = length(dx, dy, dz) * F(inverse_support);
        sum = fma(F(weight), cubic_spline(q), sum);
        closest = max(closest, F(1.0F) - q);
    }

    /// Adds the share to the gradient (the paper's Equation 2), up to a positive factor common to all particles.
    /// Returns share().
    template <class F>
    MENISCUS_HD F add_gradient(F& x, F& y, F& z, F dx, F dy, F dz) const {
        const F distance = length(dx, dy, dz);
        const F q = distance * F(inverse_support);
        const F slope = F(weight * inverse_support) * cubic_spline_derivative(q) / max(distance, F(1.0F / 64.0F));
        x = fma(slope, dx, x);
        y = fma(slope, dy, y);
        z = fma(slope, dz, z);
        return F(weight) * cubic_spline(q);
    }

    /// Adds the share to a jet.
    template <class F>
    MENISCUS_HD void add_jet(FieldJet<F>& jet, F dx, F dy, F dz) const {
        const F distance = max(length(dx, dy, dz), F(1.0F / 64.0F));
        const F q = distance * F(inverse_support);
        const F inverse = F(1.0F) / distance;
        const F scale = F(weight * inverse_support);
        jet.value = fma(F(weight), cubic_spline(q), jet.value);
        // W'/r, and what W'' has beyond it along the direction to the particle.
        const F first = scale * cubic_spline_derivative(q) * inverse;
        const F second = (scale * F(inverse_support) * cubic_spline_second_derivative(q) - first) * (inverse * inverse);
        jet.add_radial(first, second, dx, dy, dz);
    }
};

}  // namespace meniscus
