// A field at a point to second order.
#pragma once

namespace meniscus {

/// Lengths in units. F is float or Lanes.
template <class F>
struct FieldJet {
    F value = F(0.0F);
    F x = F(0.0F), y = F(0.0F), z = F(0.0F);                                               ///< gradient
    F xx = F(0.0F), yy = F(0.0F), zz = F(0.0F), xy = F(0.0F), xz = F(0.0F), yz = F(0.0F);  ///< Hessian
};

}  // namespace meniscus
