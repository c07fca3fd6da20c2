// How strongly the surface bends inside a base cell, found before anything finer than base vertices is sampled. Not in
// the paper; the curvature of level sets follows Goldman 2005 (core/README.md#the-criterion).
#pragma once

#include <cstdint>

#include "field/jet.hpp"
#include "field/lanes.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// Corner values of a cell, i = x + 2 y + 4 z, less the iso-value.
template <class F>
struct CellCorners {
    F value[8];
};

template <class F>
struct Point3 {
    F x, y, z;
};

namespace curvature_detail {

template <class F>
MENISCUS_HD inline F clamped(F v, F low, F high) {
    return F(0.0F) - max(F(0.0F) - max(v, low), F(0.0F) - high);
}

/// A squared gradient to divide by, never zero (core/README.md#divisors-1e-30-1e-15-164).
template <class F>
MENISCUS_HD inline F divisor(F x, F y, F z) {
    return max(fma(x, x, fma(y, y, z * z)), F(1e-30F));
}

}  // namespace curvature_detail

/// A point of the surface by the trilinear model of the cell's corners: three Newton steps along the gradient from the
/// middle (a fourth changes nothing: core/README.md#newton-steps-three-and-one). Coordinates of 0 to 1.
template <class F>
MENISCUS_HD inline Point3<F> trilinear_root(const CellCorners<F>& corners) {
    Point3<F> p{F(0.5F), F(0.5F), F(0.5F)};
    const F* c = corners.value;
    for (int step = 0; step < 3; ++step) {
        F plane[2][2];  // the x edges' values at p.x, and along y
        F slope_x[2][2];
        for (int z = 0; z < 2; ++z)
            for (int y = 0; y < 2; ++y) {
                slope_x[z][y] = c[1 + 2 * y + 4 * z] - c[2 * y + 4 * z];
                plane[z][y] = fma(slope_x[z][y], p.x, c[2 * y + 4 * z]);
            }
        const F low = fma(plane[0][1] - plane[0][0], p.y, plane[0][0]);
        const F high = fma(plane[1][1] - plane[1][0], p.y, plane[1][0]);
        const F value = fma(high - low, p.z, low);
        const F slope_low = fma(slope_x[0][1] - slope_x[0][0], p.y, slope_x[0][0]);
        const F slope_high = fma(slope_x[1][1] - slope_x[1][0], p.y, slope_x[1][0]);
        const F gx = fma(slope_high - slope_low, p.z, slope_low);
        const F rise_low = plane[0][1] - plane[0][0];
        const F gy = fma((plane[1][1] - plane[1][0]) - rise_low, p.z, rise_low);
        const F gz = high - low;
        const F t = value / curvature_detail::divisor(gx, gy, gz);
        p.x = curvature_detail::clamped(p.x - t * gx, F(0.0F), F(1.0F));
        p.y = curvature_detail::clamped(p.y - t * gy, F(0.0F), F(1.0F));
        p.z = curvature_detail::clamped(p.z - t * gz, F(0.0F), F(1.0F));
    }
    return p;
}

/// One Newton step of the field toward the iso-value, along the gradient. Units.
template <class F>
MENISCUS_HD inline Point3<F> newton_step(const FieldJet<F>& jet, float iso, const Point3<F>& p) {
    const F t = (jet.value - F(iso)) / curvature_detail::divisor(jet.x, jet.y, jet.z);
    return {p.x - t * jet.x, p.y - t * jet.y, p.z - t * jet.z};
}

/// How the surface bends near a point.
template <class F>
struct SurfaceBend {
    F curvature;  ///< sum of both principal curvatures' magnitudes, per unit
    F trace;      ///< of the tangential part of the field's Hessian, per unit squared
};

/// The bend of the surface near a point of a jet. The curvatures of the point's own level set are the eigenvalues of
/// the Hessian's tangential part over the length of the gradient. Level sets are taken as parallel: the surface's radii
/// of curvature differ from these by its distance, which gives a drop's size from outside of it.
template <class F>
MENISCUS_HD inline SurfaceBend<F> surface_bend(const FieldJet<F>& j, float iso) {
    const F size = max(sqrt(fma(j.x, j.x, fma(j.y, j.y, j.z * j.z))), F(1e-15F));
    const F nx = j.x / size, ny = j.y / size, nz = j.z / size;
    const F hx = fma(j.xx, nx, fma(j.xy, ny, j.xz * nz));
    const F hy = fma(j.xy, nx, fma(j.yy, ny, j.yz * nz));
    const F hz = fma(j.xz, nx, fma(j.yz, ny, j.zz * nz));
    const F trace = (j.xx + j.yy + j.zz) - fma(nx, hx, fma(ny, hy, nz * hz));
    // n . adjugate(H) n is the product of the two tangential eigenvalues.
    const F cxx = j.yy * j.zz - j.yz * j.yz, cyy = j.xx * j.zz - j.xz * j.xz, czz = j.xx * j.yy - j.xy * j.xy;
    const F cxy = j.xz * j.yz - j.xy * j.zz, cxz = j.xy * j.yz - j.xz * j.yy, cyz = j.xy * j.xz - j.yz * j.xx;
    const F product = fma(nx, fma(cxx, nx, fma(cxy, ny, cxz * nz)),
                          fma(ny, fma(cxy, nx, fma(cyy, ny, cyz * nz)), nz * fma(cxz, nx, fma(cyz, ny, czz * nz))));
    const F half = F(0.5F) * trace;
    const F spread = sqrt(max(half * half - product, F(0.0F)));
    const F climb = (F(iso) - j.value) / size;  // the surface's distance along the gradient
    const auto curvature = [&](F eigenvalue) {
        // Within a factor of 2: a gradient that almost vanishes gives neither distance nor radius.
        const F gap = curvature_detail::clamped(fma(eigenvalue, climb, size), F(0.5F) * size, F(2.0F) * size);
        return max(eigenvalue, F(0.0F) - eigenvalue) / gap;
    };
    return {curvature(half + spread) + curvature(half - spread), trace};
}

/// A cell whose corners agree is looked at once more where the first step ends this near outside of it, units
/// (measured: core/README.md#newton-steps-three-and-one).
inline constexpr float look_again_within = 0.5F * units_per_cell;

/// The result of search_surface().
template <class F>
struct SurfaceSearch {
    SurfaceBend<F> bend;
    F inside;  ///< distance of the point found from the cell's nearest face, units; negative if it left the cell
    F again;   ///< 1 where the cell was looked at once more, else 0
};

namespace curvature_detail {

/// A point's distance from the nearest face of a cell; negative outside.
template <class F>
MENISCUS_HD inline F depth_in_cell(const Point3<F>& p, const Point3<F>& corner) {
    const F edge(static_cast<float>(units_per_base_cell));
    const auto depth = [&](F v, F low) { return F(0.0F) - max(low - v, v - (low + edge)); };
    return min(min(depth(p.x, corner.x), depth(p.y, corner.y)), depth(p.z, corner.z));
}

}  // namespace curvature_detail

/// Looks for the surface in a cell: from the trilinear root where the corners' signs are mixed (1), from the middle
/// where they agree (0); then how it bends, and where a Newton step leads. A cell whose corners agree is looked at once
/// more from there, if that is near. corner: the cell's lowest point, units. jet_at: from a Point3<F> to the
/// FieldJet<F> there. any: whether an F of 0 or 1 is 1 for any of the cells that are searched together.
template <class F, class JetAt, class Any>
MENISCUS_HD inline SurfaceSearch<F> search_surface(const CellCorners<F>& corners, F mixed, const Point3<F>& corner,
                                                   float iso, const JetAt& jet_at, const Any& any) {
    using curvature_detail::clamped;
    using curvature_detail::depth_in_cell;
    const F edge(static_cast<float>(units_per_base_cell));
    const Point3<F> start = trilinear_root(corners);
    const auto blend = [&](F from, F s) { return from + edge * fma(mixed, s - F(0.5F), F(0.5F)); };
    const Point3<F> p{blend(corner.x, start.x), blend(corner.y, start.y), blend(corner.z, start.z)};
    FieldJet<F> jet = jet_at(p);
    Point3<F> end = newton_step(jet, iso, p);
    // So large that a float above zero becomes 1.
    const F is_near = clamped((depth_in_cell(end, corner) + F(look_again_within)) * F(1e30F), F(0.0F), F(1.0F));
    const F again = is_near * (F(1.0F) - mixed);
    if (any(again)) {
        const auto step = [&](F from, F to, F low) { return clamped(fma(again, to - from, from), low, low + edge); };
        const Point3<F> q{step(p.x, end.x, corner.x), step(p.y, end.y, corner.y), step(p.z, end.z, corner.z)};
        jet = jet_at(q);
        end = newton_step(jet, iso, q);
    }
    return {surface_bend(jet, iso), depth_in_cell(end, corner), again};
}

}  // namespace meniscus
