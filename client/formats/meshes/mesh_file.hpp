// Mesh files.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "formats/mesh_format.hpp"
#include "formats/named_values.hpp"
#include "formats/read_limits.hpp"
#include "formats/vtp_writer.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::formats {

/// Whether float32 may round two neighboring lattice points of this mesh to one value, so that files need float64.
/// That begins at 2^23 lattice units: float32 has 24 significant bits, and just above a power of two its steps are
/// 2^-23 of the value.
bool needs_double(const Mesh& mesh);

/// A convex quadrilateral by its corners' indices, counter-clockwise seen from outside.
using Quad = std::array<std::uint32_t, 4>;

/// A triangle mesh from a file of any program.
struct TriangleMesh {
    std::vector<std::array<double, 3>> positions;
    std::vector<Normal> normals;            ///< empty, or one per position
    std::vector<Triangle> triangles;        ///< indices into `positions`, checked
    std::vector<std::uint8_t> levels;       ///< empty, or per triangle 1, 2, 3, crack 0
    std::vector<NamedValues> attributes;    ///< of the positions
    bool wide = false;                      ///< float32 would merge positions, or round them: files need float64
    std::vector<Quad> quads;                ///< beside the triangles, of the formats that have them; readers make none
    std::vector<std::uint8_t> quad_levels;  ///< empty, or per quadrilateral as `levels`
};

TriangleMesh to_triangles(const Mesh& mesh);

/// Reads a file, or standard input for "-"; polygons are cut into fans. format: without it, the extension's. Throws
/// InvalidInput in one line that names the file.
TriangleMesh read_mesh(const std::filesystem::path& path, std::optional<MeshFormat> format = std::nullopt,
                       const ReadLimits& limits = {});

/// The readers behind read_mesh(). name: the file, for messages.
TriangleMesh read_mesh_ply(const std::string& name, std::string_view bytes);
TriangleMesh read_obj(const std::string& name, std::string_view bytes);
TriangleMesh read_mesh_vtk(const std::string& name, std::string_view bytes);
TriangleMesh read_mesh_vtp(const std::string& name, std::string_view bytes, const ReadLimits& limits);
TriangleMesh read_mesh_npz(const std::string& name, std::string_view bytes, const ReadLimits& limits);

/// Writes atomically. Positions are float32, or float64 where `wide`. Throws InvalidInput if the path cannot be
/// written, and for bricks, which encode_frame() makes of a Mesh alone. compress: smaller, where is_compressible().
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, MeshFormat format, bool compress = false);

/// The writers behind it, all of them atomic; those of a Mesh write the same bytes.
///
/// Binary PLY: normals, attributes, and per triangle a uchar `level` (1, 2, 3; crack 0). An attribute is a property of
/// its name, or with several components properties NAME_x, NAME_y, NAME_z, NAME_w; uint8 of 3 or 4 under the name
/// `color` are red, green, blue, alpha.
void write_ply(const std::filesystem::path& path, const Mesh& mesh);
void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh);
/// Wavefront OBJ with normals, the triangles in groups level1, level2, level3 and crack. It has no place for
/// attributes.
void write_obj(const std::filesystem::path& path, const Mesh& mesh);
void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh);
/// Legacy VTK, binary POLYDATA: normals and attributes as point data, `level` as cell data.
void write_mesh_vtk(const std::filesystem::path& path, const TriangleMesh& mesh);
/// VTK's XML: the same, as base64. compression: zlib's, which halves the file and takes longer.
void write_mesh_vtp(const std::filesystem::path& path, const TriangleMesh& mesh,
                    VtpCompression compression = VtpCompression::none);
/// Arrays positions (N, 3), triangles (M, 3), normals, levels, and the attributes by their names.
void write_mesh_npz(const std::filesystem::path& path, const TriangleMesh& mesh);

}  // namespace meniscus::formats
