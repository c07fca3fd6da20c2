// Whether a mesh is a closed, oriented 2-manifold: written without any knowledge of how it was made.
#pragma once

#include <cstddef>
#include <string>

#include "meniscus/mesh.hpp"

namespace meniscus::test {

struct MeshReport {
    std::size_t repeated_vertices = 0;  ///< number of vertices at the place of another
    std::size_t unused_vertices = 0;
    std::size_t degenerate_triangles = 0;  ///< number of triangles that name a vertex twice
    std::size_t unbalanced_edges = 0;      ///< number of edges that are not used equally often in both directions
    std::size_t nonmanifold_edges = 0;     ///< number of edges of more than two triangles
    std::size_t nonmanifold_vertices = 0;  ///< number of vertices whose triangles are not one fan
    double volume = 0.0;                   ///< world units cubed
    double area = 0.0;                     ///< world units squared
    std::size_t components = 0;

    bool closed_manifold() const {
        return repeated_vertices + unused_vertices + degenerate_triangles + unbalanced_edges + nonmanifold_edges +
                   nonmanifold_vertices ==
               0;
    }
    std::string text() const;
};

MeshReport check(const Mesh& mesh);

}  // namespace meniscus::test
