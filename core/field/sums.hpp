// The field and its gradient at one point, or at a register of points: sums over neighbors in their order. Kernel:
// CubicSpline or Poly6.
#pragma once

#include <cstddef>

#include "field/jet.hpp"
#include "field/lanes.hpp"
#include "field/neighbor_view.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// Adds to the values at G points (F = float), or at G registers of points (F = Lanes).
template <class Kernel, int G, class F>
MENISCUS_HD inline void sum_values(const NeighborView& near, const F (&x)[G], const F (&y)[G], const F (&z)[G],
                                   F (&sum)[G]) {
    for (std::size_t j = 0; j < near.count; ++j) {
        const auto share = Kernel::of(near, j);
        for (int g = 0; g < G; ++g)
            sum[g] = share.add_value(sum[g], x[g] - F(near.x[j]), y[g] - F(near.y[j]), z[g] - F(near.z[j]));
    }
}

/// The same for a grid of points: NY x NZ, lane by lane at (x, y[i], z[j]), i running first in `sum`.
template <class Kernel, int NY, int NZ, class F>
MENISCUS_HD inline void sum_grid_values(const NeighborView& near, F x, const F (&y)[NY], const float (&z)[NZ],
                                        F (&sum)[NY * NZ]) {
    for (std::size_t j = 0; j < near.count; ++j) {
        const auto share = Kernel::of(near, j);
        const F dx = x - F(near.x[j]);
        F dy[NY];
        for (int i = 0; i < NY; ++i) dy[i] = y[i] - F(near.y[j]);
        for (int k = 0; k < NZ; ++k) {
            const F dz(z[k] - near.z[j]);
            for (int i = 0; i < NY; ++i) sum[NY * k + i] = share.add_value(sum[NY * k + i], dx, dy[i], dz);
        }
    }
}

/// Adds to upper bounds of the field in boxes of half edge `half` around the points: every particle counts with the
/// kernel at its distance from the box. `closest`: see the kernel's add_bound().
template <class Kernel, class F>
MENISCUS_HD inline void sum_bounds(const NeighborView& near, F x, F y, F z, float half, F& sum, F& closest) {
    const auto gap = [half](F d) { return max(magnitude(d) - F(half), F(0.0F)); };
    for (std::size_t j = 0; j < near.count; ++j)
        Kernel::of(near, j).add_bound(sum, closest, gap(x - F(near.x[j])), gap(y - F(near.y[j])), gap(z - F(near.z[j])),
                                      near.support);
}

/// Adds to the gradient, up to a positive factor common to all particles (the paper's Equation 2).
template <class Kernel, class F>
MENISCUS_HD inline void sum_gradients(const NeighborView& near, F x, F y, F z, F& gx, F& gy, F& gz) {
    for (std::size_t j = 0; j < near.count; ++j)
        Kernel::of(near, j).add_gradient(gx, gy, gz, x - F(near.x[j]), y - F(near.y[j]), z - F(near.z[j]));
}

/// Adds to the sum of the particles' shares, and to the sums of the first K of their numbers, each times the share;
/// with has_gradient also to the gradient, as sum_gradients() does. numbers: four for each particle.
template <class Kernel, unsigned K, bool has_gradient, class F>
MENISCUS_HD inline void sum_numbers(const NeighborView& near, const float* numbers, F x, F y, F z, F& gx, F& gy, F& gz,
                                    F& weight, F (&sum)[K]) {
    for (std::size_t j = 0; j < near.count; ++j) {
        const auto kernel = Kernel::of(near, j);
        const F dx = x - F(near.x[j]), dy = y - F(near.y[j]), dz = z - F(near.z[j]);
        F share(0.0F);
        if constexpr (has_gradient)
            share = kernel.add_gradient(gx, gy, gz, dx, dy, dz);
        else
            share = kernel.share(dx, dy, dz);
        weight = weight + share;
        for (unsigned k = 0; k < K; ++k) sum[k] = fma(share, F(numbers[4 * j + k]), sum[k]);
    }
}

/// A gradient becomes the unit vector against it; not-a-numbers where it vanishes.
template <class F>
MENISCUS_HD inline void turn_outward(F& x, F& y, F& z) {
    const F size = F(0.0F) - sqrt(fma(x, x, fma(y, y, z * z)));
    x = x / size;
    y = y / size;
    z = z / size;
}

/// Adds to the field's jets. X: F, or what gives one less an F.
template <class Kernel, class X, class F>
MENISCUS_HD inline void sum_jets(const NeighborView& near, const X& x, F y, F z, FieldJet<F>& jet) {
    for (std::size_t j = 0; j < near.count; ++j)
        Kernel::of(near, j).add_jet(jet, x - F(near.x[j]), y - F(near.y[j]), z - F(near.z[j]));
}

}  // namespace meniscus
