#include "compare/surface.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "compare/triangle_distance.hpp"
#include "meniscus/error.hpp"

namespace meniscus::compare {

void validate(SurfaceView surface, const std::string& name) {
    if (surface.triangles.empty()) throw InvalidInput(name + ": a mesh without triangles");
    for (std::size_t i = 0; i < surface.positions.size(); ++i)
        for (const double x : surface.positions[i])
            if (!(std::abs(x) <= largest_coordinate)) {
                std::ostringstream message;
                message << name << ": vertex " << i << " has the coordinate " << x << "; meshes are compared up to "
                        << largest_coordinate;
                throw InvalidInput(message.str());
            }
    const auto has_area = [&](const Triangle& t) { return area(surface.corners(t)) > 0.0; };
    if (std::none_of(surface.triangles.begin(), surface.triangles.end(), has_area))
        throw InvalidInput(name + ": a mesh whose triangles have no area");
}

}  // namespace meniscus::compare
