// Meshes of which the distances are known.
#pragma once

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "compare/surface.hpp"

namespace meniscus::compare {

struct Shape {
    std::vector<Point> positions;
    std::vector<Triangle> triangles;

    SurfaceView view() const { return {positions, triangles}; }

    Shape& add(const Shape& other, const Point& shift = {0.0, 0.0, 0.0}, double scale = 1.0) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const Point& p : other.positions)
            positions.push_back({scale * p[0] + shift[0], scale * p[1] + shift[1], scale * p[2] + shift[2]});
        for (const Triangle& t : other.triangles) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        return *this;
    }
    Shape moved(const Point& shift, double scale = 1.0) const { return Shape().add(*this, shift, scale); }

    std::string obj() const {
        std::ostringstream out;
        out.precision(17);
        for (const Point& p : positions) out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
        for (const Triangle& t : triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
        return out.str();
    }
};

/// Edge 1, in the plane z = 0.
inline Shape square() {
    return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Edge 1, closed, its triangles counter-clockwise from outside.
inline Shape cube() {
    Shape out;
    for (int i = 0; i < 8; ++i)
        out.positions.push_back(
            {static_cast<double>(i & 1), static_cast<double>(i >> 1 & 1), static_cast<double>(i >> 2)});
    out.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return out;
}

}  // namespace meniscus::compare
