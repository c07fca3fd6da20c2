// A field at a point to second order.
#pragma once

#include "field/lanes.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// The field to second order. Lengths in units. F is float or Lanes.
template <class F>
struct FieldJet {
    F value = F(0.0F);
    F x = F(0.0F), y = F(0.0F), z = F(0.0F);                                               ///< gradient
    F xx = F(0.0F), yy = F(0.0F), zz = F(0.0F), xy = F(0.0F), xz = F(0.0F), yz = F(0.0F);  ///< Hessian

    /// Adds the derivatives of a function w of the distance r alone, at the difference (dx, dy, dz) from its center.
    /// first: w'/r; second: (w'' - w'/r)/r^2.
    MENISCUS_HD void add_radial(F first, F second, F dx, F dy, F dz) {
        x = fma(first, dx, x);
        y = fma(first, dy, y);
        z = fma(first, dz, z);
        const F sx = second * dx;
        const F sy = second * dy;
        xx = fma(sx, dx, xx) + first;
        yy = fma(sy, dy, yy) + first;
        zz = fma(second * dz, dz, zz) + first;
        xy = fma(sx, dy, xy);
        xz = fma(sx, dz, xz);
        yz = fma(sy, dz, yz);
    }
};

}  // namespace meniscus
