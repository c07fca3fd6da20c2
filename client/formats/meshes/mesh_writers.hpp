// Writers of mesh files, beside glb_writer.hpp and usda_writer.hpp. The formats that use them: mesh_formats.hpp.
#pragma once

#include <filesystem>

#include "formats/meshes/mesh_writing.hpp"
#include "formats/meshes/triangle_mesh.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::formats {

// All of them write atomically, and throw InvalidInput if the path cannot be written. Positions are float32, or float64
// where `wide`. Those of a Mesh write the same bytes.

/// Binary PLY: normals, attributes, and per triangle a uchar `level` (1, 2, 3; crack 0). An attribute is a property of
/// its name, or with several components properties NAME_x, NAME_y, NAME_z, NAME_w; uint8 of 3 or 4 under the name
/// `color` are red, green, blue, alpha.
void write_ply(const std::filesystem::path& path, const Mesh& mesh);
void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing = {});
/// Wavefront OBJ with normals, the triangles in groups level1, level2, level3 and crack. It has no place for
/// attributes.
void write_obj(const std::filesystem::path& path, const Mesh& mesh);
void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing = {});
/// Legacy VTK, binary POLYDATA: normals and attributes as point data, `level` as cell data.
void write_mesh_vtk(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing = {});
/// VTK's XML: the same, as base64. Compressed by zlib, which halves the file and takes longer.
void write_mesh_vtp(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing = {});
/// The same as an unstructured grid, which programs read that know no polygonal data.
void write_mesh_vtu(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing = {});
/// Binary STL: three corners and a normal for each triangle, all float32. It has no place for anything else.
void write_stl(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing = {});
/// Arrays positions (N, 3), triangles (M, 3), normals, levels, and the attributes by their names.
void write_mesh_npz(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing = {});

}  // namespace meniscus::formats
