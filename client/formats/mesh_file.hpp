// Mesh files: PLY, OBJ and bricks.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "formats/mesh_format.hpp"
#include "formats/named_values.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::formats {

/// Writes binary PLY: positions, normals if the mesh has them, triangles, and per triangle a uchar `level` (1, 2, 3;
/// crack 0). Atomic. Throws InvalidInput if the path cannot be written.
void write_ply(const std::filesystem::path& path, const Mesh& mesh);
/// Writes Wavefront OBJ with normals, the triangles in groups level1, level2, level3 and crack.
void write_obj(const std::filesystem::path& path, const Mesh& mesh);

/// Whether float32 may round two neighboring lattice points of this mesh to one value, so that files need float64.
/// That begins at 2^23 lattice units: float32 has 24 significant bits, and just above a power of two its steps are
/// 2^-23 of the value.
bool needs_double(const Mesh& mesh);

/// A triangle mesh from a file of any program.
struct TriangleMesh {
    std::vector<std::array<double, 3>> positions;
    std::vector<Normal> normals;          ///< empty, or one per position
    std::vector<Triangle> triangles;      ///< indices into `positions`, checked
    std::vector<std::uint8_t> levels;     ///< empty, or per triangle 1, 2, 3, crack 0
    std::vector<NamedValues> attributes;  ///< of the positions
    bool wide = false;                    ///< float32 would merge positions: files need float64
};

TriangleMesh to_triangles(const Mesh& mesh);

/// Reads a file, or standard input for "-"; polygons are cut into fans. format: without it, the extension's. Throws
/// InvalidInput in one line that names the file.
TriangleMesh read_mesh(const std::filesystem::path& path, std::optional<MeshFormat> format = std::nullopt);

/// The readers behind read_mesh(). name: the file, for messages.
TriangleMesh read_mesh_ply(const std::string& name, std::string_view bytes);
TriangleMesh read_obj(const std::string& name, std::string_view bytes);

}  // namespace meniscus::formats
