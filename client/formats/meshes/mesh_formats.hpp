// The formats of mesh files.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace meniscus::formats {

/// A name is also the file's extension.
enum class MeshFormat {
    ply,
    obj,
    bricks,
    vtk,   ///< legacy VTK
    vtp,   ///< VTK's XML, polygonal data
    npz,   ///< numpy, zipped arrays
    glb,   ///< glTF, binary; written only
    usda,  ///< USD as text; written only
};
constexpr std::string_view name_of(MeshFormat format) {
    switch (format) {
        case MeshFormat::ply:
            return "ply";
        case MeshFormat::obj:
            return "obj";
        case MeshFormat::bricks:
            return "bricks";
        case MeshFormat::vtk:
            return "vtk";
        case MeshFormat::vtp:
            return "vtp";
        case MeshFormat::npz:
            return "npz";
        case MeshFormat::glb:
            return "glb";
        case MeshFormat::usda:
            return "usda";
    }
    return {};
}

/// The extensions of mesh files, with their dots.
std::span<const std::string_view> mesh_extensions();
/// The names of the formats that are read.
std::span<const std::string_view> read_mesh_formats();

/// glTF by Draco, which rounds positions to 2^16 steps over the mesh; VTK's XML by zlib.
constexpr bool is_compressible(MeshFormat format) {
    return format == MeshFormat::glb || format == MeshFormat::vtp;
}

/// The format that the extension names. Throws InvalidInput for any other extension.
MeshFormat mesh_format_of(const std::filesystem::path& path);

}  // namespace meniscus::formats
