// The formats of mesh files, a row each. A new format is the file of its reader, of its writer, or both, its
// enumerator, and its row.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "formats/bytes/read_limits.hpp"
#include "formats/meshes/glb_writer.hpp"
#include "formats/meshes/mesh_readers.hpp"
#include "formats/meshes/mesh_writers.hpp"
#include "formats/meshes/mesh_writing.hpp"
#include "formats/meshes/triangle_mesh.hpp"
#include "formats/meshes/usda_writer.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/names.hpp"

namespace meniscus::formats {

enum class MeshFormat { ply, obj, bricks, vtk, vtp, vtu, npz, glb, usda, stl };

struct MeshFormatTraits {
    bool compressible = false;
    bool quads = false;  ///< quadrilaterals are written as such
};

struct MeshFormatRow {
    MeshFormat format;
    std::string_view name;
    std::string_view extension;  ///< in lower case, with its dot
    /// Null: it is written only.
    TriangleMesh (*read)(const std::string& name, std::string_view bytes, const ReadLimits& limits);
    /// Null: triangles alone are not written so.
    void (*write)(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing);
    /// Writes a mesh as it was reconstructed, to the same bytes. Null: it is written as triangles.
    void (*write_reconstructed)(const std::filesystem::path& path, const Mesh& mesh) = nullptr;
    MeshFormatTraits traits = {};
};

/// The formats in the order of the enumerators, in which they are listed.
inline constexpr std::array mesh_formats{
    MeshFormatRow{MeshFormat::ply, "ply", ".ply", read_mesh_ply, write_ply, write_ply},
    MeshFormatRow{MeshFormat::obj, "obj", ".obj", read_obj, write_obj, write_obj, {.quads = true}},
    MeshFormatRow{MeshFormat::bricks, "bricks", ".bricks", read_mesh_bricks, nullptr},
    MeshFormatRow{MeshFormat::vtk, "vtk", ".vtk", read_mesh_vtk, write_mesh_vtk, nullptr, {.quads = true}},
    MeshFormatRow{
        MeshFormat::vtp, "vtp", ".vtp", read_mesh_vtp, write_mesh_vtp, nullptr, {.compressible = true, .quads = true}},
    MeshFormatRow{
        MeshFormat::vtu, "vtu", ".vtu", read_mesh_vtp, write_mesh_vtu, nullptr, {.compressible = true, .quads = true}},
    MeshFormatRow{MeshFormat::npz, "npz", ".npz", read_mesh_npz, write_mesh_npz},
    MeshFormatRow{MeshFormat::glb, "glb", ".glb", nullptr, write_glb, nullptr, {.compressible = true}},
    MeshFormatRow{MeshFormat::usda, "usda", ".usda", nullptr, write_usda},
    MeshFormatRow{MeshFormat::stl, "stl", ".stl", nullptr, write_stl},
};

constexpr const MeshFormatRow& row_of(MeshFormat format) {
    return mesh_formats[static_cast<std::size_t>(format)];
}
/// Nothing for a value that is no enumerator.
constexpr std::string_view name_of(MeshFormat format) {
    return static_cast<std::size_t>(format) < mesh_formats.size() ? row_of(format).name : std::string_view{};
}
static_assert(
    [] {
        for (const MeshFormat format : choices<MeshFormat>)
            if (row_of(format).format != format) return false;
        return true;
    }(),
    "the rows are in the order of the enumerators");

/// The extensions of mesh files, with their dots.
std::span<const std::string_view> mesh_extensions();
/// The names of the formats that are read.
std::span<const std::string_view> read_mesh_formats();

/// glTF by Draco, which rounds positions to 2^16 steps over the mesh; VTK's XML by zlib.
constexpr bool is_compressible(MeshFormat format) {
    return row_of(format).traits.compressible;
}

/// The format that the extension names. Throws InvalidInput for any other extension.
MeshFormat mesh_format_of(const std::filesystem::path& path);

}  // namespace meniscus::formats
