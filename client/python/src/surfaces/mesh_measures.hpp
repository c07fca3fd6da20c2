// What a mesh measures in the world.
#pragma once

#include "meniscus/mesh.hpp"

namespace meniscus::python {

/// Of all triangles, world units squared.
double area_of(const Mesh& mesh);
/// That the triangles enclose, world units cubed.
double volume_of(const Mesh& mesh);

}  // namespace meniscus::python
