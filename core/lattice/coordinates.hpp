// The lattice: integer points at the finest spacing c, anchored at the world's origin.
//
// Three units are in use. A *unit* is c/4096, the fraction to which particles are snapped, so that differences of
// positions are exact; a *cell* is c; a *base cell* (a level-1 cell of the paper) is 4 c and is the block in which
// lattice points are stored.
#pragma once

#include <cmath>
#include <cstdint>

#include "lattice/host_device.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus {

struct Int3 {
    std::int32_t x = 0, y = 0, z = 0;
    MENISCUS_HD constexpr bool operator==(const Int3& o) const { return x == o.x && y == o.y && z == o.z; }
    MENISCUS_HD constexpr Int3 operator+(const Int3& o) const { return {x + o.x, y + o.y, z + o.z}; }
    MENISCUS_HD constexpr Int3 operator-(const Int3& o) const { return {x - o.x, y - o.y, z - o.z}; }
};

/// A position in units of c/4096.
struct Units3 {
    std::int64_t x = 0, y = 0, z = 0;
};

inline constexpr int units_per_cell = 4096;
inline constexpr int units_per_base_cell = units_per_cell * base_cell_size;
/// The same as a coordinate.
inline constexpr float base_edge = units_per_base_cell;

/// Base cells are addressed with 21 bits a side, so that three coordinates and thirteen more bits fit a 64-bit key
/// and a vertex on the lattice refined 64-fold fits int32.
inline constexpr std::int32_t max_base_cell = (1 << 20) - 1;
/// Largest |position| of a particle, in cells: leaves room for the largest support.
inline constexpr std::int64_t max_cell = (std::int64_t{max_base_cell} - 128) * base_cell_size;

/// Largest kernel support, in cells: keeps every difference that a kernel sees exact in float32.
inline constexpr int max_support_cells = 256;

/// The quotient rounded down; |a| < 2^53, b > 0. In double, which is faster than int64 and as exact: a quotient that is
/// not whole is at least 1/b below the next whole number, and rounding moves it by less.
MENISCUS_HD inline std::int64_t floor_div(std::int64_t a, std::int64_t b) {
    return static_cast<std::int64_t>(floor(static_cast<double>(a) / static_cast<double>(b)));
}

/// The edge of support cells: at least the support (so that a point's neighbors lie in 27 cells), at least a base cell
/// (so that keys fit), and a multiple of 16 (so that the distance of two brick corners is exact in float32).
MENISCUS_HD constexpr std::int64_t support_cell_units(std::int64_t support_units) {
    const std::int64_t edge = support_units > units_per_base_cell ? support_units : units_per_base_cell;
    return (edge + 15) / 16 * 16;
}

/// World coordinate to units; units_per_length = 4096 / c in double.
MENISCUS_HD inline std::int64_t snap(double position, double units_per_length) {
#ifdef __CUDA_ARCH__
    return __double2ll_rn(position * units_per_length);
#else
    return static_cast<std::int64_t>(__builtin_rint(position * units_per_length));
#endif
}

MENISCUS_HD inline Units3 base_cell_origin(const Int3& b) {
    return {std::int64_t{b.x} * units_per_base_cell, std::int64_t{b.y} * units_per_base_cell,
            std::int64_t{b.z} * units_per_base_cell};
}

}  // namespace meniscus
