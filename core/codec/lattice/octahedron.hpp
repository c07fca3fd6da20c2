// Unit vectors as points of an octahedron's unfolded surface, on a square grid: the numbers that Draco gives normals,
// so that a normal is the same through either codec.
//
// (Meyer, Suessmuth, Sussner, Stamminger, Greiner 2010: On floating-point normal vectors.)
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "lattice/host_device.hpp"

namespace meniscus {

/// Each of the two numbers takes `bits` bits, 2 to 16.
class Octahedron {
public:
    MENISCUS_HD explicit Octahedron(int bits) : center_((1 << (bits - 1)) - 1) {}

    /// The sum of the magnitudes of a point's coordinates.
    int radius() const { return center_; }

    /// A point on the octahedron: |x| + |y| + |z| = radius().
    using Point = std::array<int, 3>;

    /// The point nearest to a vector's direction, about; any point for a vector of zeros.
    MENISCUS_HD Point point(const std::array<float, 3>& vector) const {
        const double x = vector[0];
        const double y = vector[1];
        const double z = vector[2];
        const double sum = std::abs(x) + std::abs(y) + std::abs(z);
        if (!(sum > 1e-6)) return {center_, 0, 0};
        const double scale = 1.0 / sum;
        Point p{static_cast<int>(std::floor(x * scale * center_ + 0.5)),
                static_cast<int>(std::floor(y * scale * center_ + 0.5)), 0};
        p[2] = center_ - std::abs(p[0]) - std::abs(p[1]);
        if (p[2] < 0) {
            p[1] += p[1] > 0 ? p[2] : -p[2];
            p[2] = 0;
        }
        if (z < 0) p[2] = -p[2];
        return p;
    }
    /// Its two numbers, the first in the lower 16 bits. Several pairs stand for one point where the surface was cut
    /// open; this is the one of them that is used.
    MENISCUS_HD std::uint32_t code(const Point& p) const {
        const int last = 2 * center_;
        int s;
        int t;
        if (p[0] >= 0) {
            s = p[1] + center_;
            t = p[2] + center_;
        } else {
            s = p[1] < 0 ? std::abs(p[2]) : last - std::abs(p[2]);
            t = p[2] < 0 ? std::abs(p[1]) : last - std::abs(p[1]);
        }
        if ((s == 0 && (t == 0 || t == last)) || (s == last && t == 0)) {
            s = last;
            t = last;
        } else if ((s == 0 && t > center_) || (s == last && t < center_)) {
            t = last - t;
        } else if ((t == last && s < center_) || (t == 0 && s > center_)) {
            s = last - s;
        }
        return static_cast<std::uint32_t>(s) | static_cast<std::uint32_t>(t) << 16;
    }
    /// Whether a code has both numbers in range.
    bool holds(std::uint32_t code) const {
        const auto last = static_cast<std::uint32_t>(2 * center_);
        return (code & 0xFFFF) <= last && code >> 16 <= last;
    }
    Point point_of(std::uint32_t code) const {
        const int y = static_cast<int>(code & 0xFFFF) - center_;
        const int z = static_cast<int>(code >> 16) - center_;
        const int x = center_ - std::abs(y) - std::abs(z);
        if (x >= 0) return {x, y, z};
        return {x, y < 0 ? y - x : y + x, z < 0 ? z - x : z + x};
    }
    /// A unit vector.
    std::array<float, 3> vector(std::uint32_t code) const {
        const float scale = 2.0F / static_cast<float>(2 * center_);
        float y = static_cast<float>(code & 0xFFFF) * scale - 1.0F;
        float z = static_cast<float>(code >> 16) * scale - 1.0F;
        const float x = 1.0F - std::abs(y) - std::abs(z);
        const float folded = x < 0.0F ? -x : 0.0F;
        y += y < 0.0F ? folded : -folded;
        z += z < 0.0F ? folded : -folded;
        const float size = 1.0F / std::sqrt(x * x + y * y + z * z);
        const std::array<float, 3> first{x * size, y * size, z * size};
        const float again = std::sqrt(first[0] * first[0] + first[1] * first[1] + first[2] * first[2]);
        return {first[0] / again, first[1] / again, first[2] / again};
    }

private:
    int center_;
};

}  // namespace meniscus
