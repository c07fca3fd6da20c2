// Whether a triangle mesh is a closed, oriented 2-manifold.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compare/surface.hpp"

namespace meniscus::compare {

/// Counts of defects; a closed, oriented 2-manifold has none.
struct Defects {
    std::size_t repeated_vertices = 0;     ///< vertices at the position of another one
    std::size_t unused_vertices = 0;       ///< vertices of no triangle
    std::size_t degenerate_triangles = 0;  ///< triangles with a vertex twice; the counts below leave them out
    std::size_t unbalanced_edges = 0;  ///< edges not used equally often in both directions: borders, flipped triangles
    std::size_t border_edges = 0;      ///< those of the unbalanced edges that one triangle alone has; not in count()
    std::size_t crowded_edges = 0;     ///< edges of more than two triangles
    std::size_t torn_vertices = 0;     ///< vertices whose triangles are not connected across edges

    std::size_t count() const {
        return repeated_vertices + unused_vertices + degenerate_triangles + unbalanced_edges + crowded_edges +
               torn_vertices;
    }
    bool closed() const { return count() == 0; }
    /// "2 repeated vertices, 5 unbalanced edges"; empty without defects.
    std::string text() const;
    /// What each kind of defect that there is means, with its count.
    std::vector<std::string> lines() const;
};

Defects find_defects(SurfaceView surface);

}  // namespace meniscus::compare
