// A glTF mesh coded by Draco (KHR_draco_mesh_compression).
#pragma once

#include <vector>

#include "files/glb_document.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::formats {

/// Adds a mesh to a document. all: the positions first. Throws NotBuilt in a build without Draco.
void add_draco(const std::vector<files::GlbVertices>& all, const files::GlbBounds& bounds,
               const std::vector<Triangle>& triangles, files::GlbDocument& document);

}  // namespace meniscus::formats
