// Pairs of triangles as quadrilaterals.
#pragma once

#include "formats/meshes/triangle_mesh.hpp"

namespace meniscus::editing {

/// Which pairs of triangles are merged. A diagonal of the quadrilateral is the edge that the two share.
struct QuadCriteria {
    double largest_normal_angle = 10.0;   ///< degrees between the two triangles' normals
    double largest_corner_angle = 135.0;  ///< degrees, of each of the four corners; below 180, so that it is convex
    double largest_edge_ratio = 1.75;     ///< of each edge to each diagonal, either way round
};

/// Merges pairs of triangles of one level that share an edge: the pairs whose corners are nearest to right angles come
/// first, those equally good in the order of their triangles. Each goes from `triangles` and `levels` to `quads` and
/// `quad_levels`, in the order of their first triangles; vertices stay. An edge of more than two triangles stays one.
void merge_to_quads(formats::TriangleMesh& mesh, const QuadCriteria& criteria = {});

}  // namespace meniscus::editing
