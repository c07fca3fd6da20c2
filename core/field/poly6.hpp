// The kernel of the smooth field: Müller's poly6 (2003) of compact support h, W(d) / W(0) = max(1 - d^2/h^2, 0)^3. It
// needs no root, no division and no branch, and each particle may have a support of its own.
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/jet.hpp"
#include "field/lanes.hpp"
#include "field/neighbor_view.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// The cube root of a number of 1e-30 to 1e30, to a few units in the last place; the same bits everywhere.
MENISCUS_HD inline float cube_root(float x) {
    // A third of the exponent, then Newton's method.
    std::uint32_t bits = 0;
    __builtin_memcpy(&bits, &x, sizeof bits);
    bits = bits / 3 + 0x2A51'4067U;
    float y = 0.0F;
    __builtin_memcpy(&y, &bits, sizeof y);
    for (int step = 0; step < 4; ++step) y = fma(2.0F, y, x / (y * y)) / 3.0F;
    return y;
}

/// One particle's share in the smooth field: max(weight - fall d^2, 0)^3, the kernel with the cube root of its factor
/// multiplied in. Distances in units.
struct Poly6 {
    static constexpr bool has_own_support = true;

    float weight;  ///< cube root of the share at the particle's place
    float fall;    ///< weight / h^2, see fall_of()

    MENISCUS_HD static Poly6 of(const NeighborView& near, std::size_t j) { return {near.weight[j], near.fall[j]}; }

    /// A little more than weight / h^2, so that the share is exactly zero from a distance of h on: squared distances
    /// and this quotient are off by a few 2^-24.
    MENISCUS_HD static float fall_of(float weight, float support) {
        return weight / (support * support) * (1.0F + 0x1p-20F);
    }
    /// Adds nothing anywhere.
    MENISCUS_HD static Poly6 none() { return {0.0F, 1.0F}; }
    /// h, to a few 2^-20.
    MENISCUS_HD float support() const { return sqrt(weight / fall); }
    /// The difference along z comes last: points of a grid that differ in z alone share the rest.
    template <class F>
    MENISCUS_HD static F squared_distance(F dx, F dy, F dz) {
        return fma(dz, dz, fma(dy, dy, dx * dx));
    }

    template <class F>
    MENISCUS_HD F share(F dx, F dy, F dz) const {
        const F a = root_of_share(squared_distance(dx, dy, dz));
        return (a * a) * a;
    }

    template <class F>
    MENISCUS_HD F root_of_share(F d2) const {
        return max(fnma(F(fall), d2, F(weight)), F(0.0F));
    }

    /// The strength, of which add_strength() makes a share: its cube root.
    template <class F>
    MENISCUS_HD F strength(F dx, F dy, F dz) const {
        return root_of_share(squared_distance(dx, dy, dz));
    }
    template <class F>
    MENISCUS_HD F add_strength(F sum, F a) const {
        return fma(a * a, a, sum);
    }
    /// Adds the share to the value.
    template <class F>
    MENISCUS_HD F add_value(F sum, F dx, F dy, F dz) const {
        return add_strength(sum, strength(dx, dy, dz));
    }

    /// The same for an upper bound, by the distance from a box. `closest` becomes the largest 1 - distance^2/h^2 of the
    /// particles that are no part of a body of fluid: those whose support is less than 0.98 of the widest.
    template <class F>
    MENISCUS_HD void add_bound(F& sum, F& closest, F dx, F dy, F dz, float widest) const {
        const F a = root_of_share(squared_distance(dx, dy, dz));
        sum = fma(a * a, a, sum);
        const bool is_narrow = fall * ((0.98F * 0.98F) * widest * widest) > weight;
        if (is_narrow && weight > 0.0F) closest = max(closest, a / F(weight));
    }

    /// Adds the share to the gradient (the paper's Equation 2), up to the factor 6 that all particles share. Returns
    /// share().
    template <class F>
    MENISCUS_HD F add_gradient(F& x, F& y, F& z, F dx, F dy, F dz) const {
        const F a = root_of_share(squared_distance(dx, dy, dz));
        const F a2 = a * a;
        const F slope = a2 * F(-fall);
        x = fma(slope, dx, x);
        y = fma(slope, dy, y);
        z = fma(slope, dz, z);
        return a2 * a;
    }

    /// Adds the share to a jet.
    template <class F>
    MENISCUS_HD void add_jet(FieldJet<F>& jet, F dx, F dy, F dz) const {
        const F a = root_of_share(squared_distance(dx, dy, dz));
        const F a2 = a * a;
        jet.value = fma(a2, a, jet.value);
        const F first = a2 * F(-6.0F * fall);
        const F second = a * F(24.0F * fall * fall);
        jet.add_radial(first, second, dx, dy, dz);
    }
};

/// A particle's share in the number of particles around a place, where the level's support is that of the count.
struct Company {
    MENISCUS_HD static Poly6 of(const NeighborView& near, std::size_t) {
        return {1.0F, Poly6::fall_of(1.0F, near.support)};
    }
};

}  // namespace meniscus
