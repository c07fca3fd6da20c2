// Readers of mesh files, one for each form of bytes. The formats that use them: mesh_formats.hpp.
#pragma once

#include <string>
#include <string_view>

#include "formats/bytes/read_limits.hpp"
#include "formats/meshes/triangle_mesh.hpp"

namespace meniscus::formats {

/// name: the file, for messages. limits: for readers that decompress or that take memory beyond the bytes' own. Throw
/// InvalidInput, in one line that names the file, for bytes that are not of the format.
TriangleMesh read_mesh_ply(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
TriangleMesh read_obj(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
/// The mesh of the first frame.
TriangleMesh read_mesh_bricks(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
TriangleMesh read_mesh_vtk(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
TriangleMesh read_mesh_vtp(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});
TriangleMesh read_mesh_npz(const std::string& name, std::string_view bytes, const ReadLimits& limits = {});

}  // namespace meniscus::formats
