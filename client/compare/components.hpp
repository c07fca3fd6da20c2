// The connected components of a surface.
#pragma once

#include <cstdint>
#include <vector>

#include "compare/surface.hpp"

namespace meniscus::compare {

/// Triangles that share a vertex index are connected.
struct Components {
    std::vector<std::uint32_t> starts;     ///< component k is triangles[starts[k]] ... triangles[starts[k + 1] - 1]
    std::vector<std::uint32_t> triangles;  ///< the surface's triangles by component, ascending within each

    std::size_t count() const { return starts.size() - 1; }
};

/// Components are numbered by their first triangle.
Components find_components(SurfaceView surface);

}  // namespace meniscus::compare
