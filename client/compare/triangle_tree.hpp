// Finds the triangle of a surface that is nearest to a point.
//
// By hand, since distances are to be exact in double precision: Embree's trees and point queries are of floats.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compare/surface.hpp"

namespace meniscus::compare {

/// Triangles in Morton order under a tree of boxes with a fixed number of children: no node holds a pointer.
class TriangleTree {
public:
    /// Copies the triangles, of which there must be at least one.
    explicit TriangleTree(SurfaceView surface);

    /// Square of the exact distance from `point` to the surface. hint: any number on the first call, then the value
    /// that the last call left. It makes calls fast where consecutive points are close together, and does not change
    /// the result.
    double squared_distance(const Point& point, std::uint32_t& hint) const;

private:
    struct Box {
        Point low;
        Point high;
    };
    static double squared_distance(const Point& point, const Box& box);

    std::vector<std::array<Point, 3>> triangles_;
    std::vector<std::vector<Box>> levels_;  ///< from the boxes of triangles to the root
};

}  // namespace meniscus::compare
