// Whether a triangle mesh is a closed, oriented 2-manifold.
#pragma once

#include <cstddef>
#include <string>

#include "compare/surface.hpp"

namespace meniscus::compare {

/// Counts of what a closed, oriented 2-manifold has none of.
struct Defects {
    std::size_t repeated_vertices = 0;     ///< at the place of another
    std::size_t unused_vertices = 0;       ///< of no triangle
    std::size_t degenerate_triangles = 0;  ///< that name a vertex twice; the counts below do without them
    std::size_t unbalanced_edges = 0;      ///< not used equally often in both directions: borders, turned triangles
    std::size_t crowded_edges = 0;         ///< of more than two triangles
    std::size_t torn_vertices = 0;         ///< whose triangles do not hang together across edges

    std::size_t count() const {
        return repeated_vertices + unused_vertices + degenerate_triangles + unbalanced_edges + crowded_edges +
               torn_vertices;
    }
    bool closed() const { return count() == 0; }
    /// "2 repeated vertices, 5 unbalanced edges"; empty if there is nothing.
    std::string text() const;
};

Defects find_defects(SurfaceView surface);

}  // namespace meniscus::compare
