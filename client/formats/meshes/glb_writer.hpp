// glTF in one file.
#pragma once

#include <filesystem>
#include <string>

#include "formats/meshes/mesh_writing.hpp"
#include "formats/meshes/triangle_mesh.hpp"

namespace meniscus::formats {

enum class GlbCoding {
    plain,  ///< read by everything that reads glTF
    draco,  ///< a tenth of the size; positions on 2^16 steps over the mesh
};

/// The file's bytes. Attributes are `_NAME`, `color` of uint8 is COLOR_0. Throws LimitExceeded beyond 4 GiB.
std::string to_glb(const TriangleMesh& mesh, GlbCoding coding = GlbCoding::plain);
/// Atomic; compressed by Draco. Throws InvalidInput if the path cannot be written.
void write_glb(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing = {});

}  // namespace meniscus::formats
