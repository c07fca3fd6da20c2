// The volume that a closed mesh encloses, exactly: a sum of integers over its triangles.
//
// By the divergence theorem for the field (0, 0, z), the volume is the sum over all triangles of the mean z of their
// corners times their signed area seen along z. Vertices are integers in units of u = c / 2^offset_bits, so that six
// times the volume is an integer in units of u^3. It is summed modulo 2^64, where the order of the summands is without
// meaning: the total is exact if it fits int64.
//
// The total fits for any mesh with up to seven offset_bits: fewer than 2^32 base cells of 64 c^3 can be numbered, and
// 6 * 2^38 * 2^21 < 2^63. With eight (bisection of seven steps) it fits up to 1.4 billion base cells of water.
#pragma once

#include <cstdint>

#include "lattice/host_device.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus {

/// A triangle's part of six times the volume, u^3. Its corners lie in one base cell, at most 2^10 u apart, so that
/// every factor below fits int32 and no product overflows int64. I is std::int64_t, or several of them at once.
template <class I>
MENISCUS_HD inline I sixfold_volume(const I (&x)[3], const I (&y)[3], const I (&z)[3]) {
    const I doubled_area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    const I below_first = doubled_area * z[0];
    return below_first + below_first + below_first + doubled_area * ((z[1] - z[0]) + (z[2] - z[0]));
}

MENISCUS_HD inline std::int64_t sixfold_volume(const LatticePosition* vertices, const Triangle& triangle) {
    std::int64_t x[3], y[3], z[3];
    for (int i = 0; i < 3; ++i) {
        const LatticePosition& corner = vertices[triangle[static_cast<std::size_t>(i)]];
        x[i] = corner[0];
        y[i] = corner[1];
        z[i] = corner[2];
    }
    return sixfold_volume(x, y, z);
}

/// World units cubed. sixfold: the sum over all triangles, modulo 2^64. cell_size: c, world units.
inline double world_volume(std::uint64_t sixfold, double cell_size, std::uint32_t offset_bits) {
    const double unit = cell_size / static_cast<double>(1U << offset_bits);
    return static_cast<double>(static_cast<std::int64_t>(sixfold)) * (unit * unit * unit) / 6.0;
}

}  // namespace meniscus
