// Few particles with nothing around them.
#pragma once

#include <string>
#include <vector>

#include "compare/surface.hpp"
#include "quality/shapes.hpp"

namespace meniscus::benchmarks::quality {

struct Group {
    std::string name;
    std::vector<Point> places;  ///< radii
};

/// One particle; two at 2 r; three in one place, and in a triangle of edge 1.5 r; a tetrahedron of edge 2 r; cubes of
/// eight with edges 2 r and 1.6 r; 27 in a cube, 2 r apart; rows of ten, 2 r and 1 r apart.
std::vector<Group> make_groups();

/// The group turned and moved in the `placement`th of several fixed ways, so that no figure is that of one place on the
/// lattice.
inline constexpr int placements = 8;
std::vector<Point> place(const Group& group, int placement);

struct GroupFigures {
    double volume = 0.0;   ///< enclosed, over 8 r^3 for each particle
    std::size_t lost = 0;  ///< particles outside of the surface
};

/// surface: in radii, maybe without triangles.
GroupFigures judge_group(const std::vector<Point>& places, compare::SurfaceView surface);

}  // namespace meniscus::benchmarks::quality
