// The choice of a field's kernel.
#pragma once

#include "field/cubic_spline.hpp"
#include "field/lattice_settings.hpp"
#include "field/poly6.hpp"

namespace meniscus {

/// Calls visit.operator()<Kernel>() with the kernel of the field.
template <class Visit>
decltype(auto) with_kernel(const LatticeSettings& settings, Visit&& visit) {
    return settings.has_own_supports ? visit.template operator()<Poly6>() : visit.template operator()<CubicSpline>();
}

}  // namespace meniscus
