// The triangles of a part of space.
#pragma once

#include "formats/meshes/triangle_mesh.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::editing {

/// Leaves out the triangles without a corner in the box, whose border belongs to it; the others stay whole, so that the
/// mesh may reach out of the box by a triangle. Vertices of no triangle go, with all that they have; order stays.
void keep_touching(formats::TriangleMesh& mesh, const Box& box);

}  // namespace meniscus::editing
