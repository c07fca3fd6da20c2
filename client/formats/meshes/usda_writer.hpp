// USD as text.
#pragma once

#include <filesystem>
#include <span>

#include "formats/meshes/mesh_writing.hpp"
#include "formats/meshes/triangle_mesh.hpp"

namespace meniscus::formats {

/// Writes a prim "/surface": positions, triangles, normals and attributes, which are `primvars:NAME` (`primvars:_2nd`
/// for `2nd`, since no name of USD begins with a digit), but `velocity`, which is `velocities`, by which renderers
/// blur.
/// Atomic. Throws InvalidInput if the path cannot be written.
void write_usda(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing = {});

struct UsdaClip {
    double time = 0.0;  ///< time code
    std::filesystem::path file;
};

/// Writes a stage that shows each file's mesh from its time on. clips: in the order of their times. like: has the
/// attributes that all of them have.
void write_usda_clips(const std::filesystem::path& path, std::span<const UsdaClip> clips, const TriangleMesh& like);

}  // namespace meniscus::formats
