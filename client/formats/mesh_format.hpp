// The formats of mesh files.
#pragma once

#include <filesystem>
#include <string_view>

namespace meniscus::formats {

/// A name is also the file's extension.
enum class MeshFormat { ply, obj, bricks };
constexpr std::string_view name_of(MeshFormat format) {
    switch (format) {
        case MeshFormat::ply:
            return "ply";
        case MeshFormat::obj:
            return "obj";
        case MeshFormat::bricks:
            return "bricks";
    }
    return {};
}

/// The format that the extension names. Throws InvalidInput for any other extension.
MeshFormat mesh_format_of(const std::filesystem::path& path);

}  // namespace meniscus::formats
