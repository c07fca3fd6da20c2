// Surfaces to files.
#pragma once

#include <filesystem>
#include <string_view>

#include "cli/surfaces.hpp"

namespace meniscus::cli {

/// The formats that meshes are written in; a name is also the file's extension.
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

/// Throws InvalidInput unless the path's folder exists: to be called before long work.
void check_folder(const std::filesystem::path& path);
/// Throws InvalidInput unless the extension names a MeshFormat and the folder exists: to be called before long work.
void check_mesh_path(const std::filesystem::path& path);
/// The same of a file of points, which is PLY.
void check_points_path(const std::filesystem::path& path);
/// Throws InvalidInput unless these settings bring points for a file of spray: to be called before long work.
void check_spray(const Settings& settings);
/// Writes the format that the extension names.
void write_surface(const std::filesystem::path& path, const Surface& surface);

/// "DIR/frame_000012.ply"
std::filesystem::path frame_path(const std::filesystem::path& directory, std::uint64_t index,
                                 std::string_view extension);

}  // namespace meniscus::cli
