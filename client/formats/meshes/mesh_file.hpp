// Mesh files, of any format.
#pragma once

#include <filesystem>
#include <optional>

#include "formats/bytes/read_limits.hpp"
#include "formats/meshes/mesh_formats.hpp"
#include "formats/meshes/mesh_writing.hpp"
#include "formats/meshes/triangle_mesh.hpp"

namespace meniscus::formats {

/// Reads a file, or standard input for "-"; polygons are cut into fans. format: without it, the extension's. Throws
/// InvalidInput in one line that names the file.
TriangleMesh read_mesh(const std::filesystem::path& path, std::optional<MeshFormat> format = std::nullopt,
                       const ReadLimits& limits = {});

/// Writes atomically. Positions are float32, or float64 where `wide`. Throws InvalidInput if the path cannot be
/// written, and for bricks, which encode_frame() makes of a Mesh alone.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, MeshFormat format,
                const MeshWriting& writing = {});

}  // namespace meniscus::formats
