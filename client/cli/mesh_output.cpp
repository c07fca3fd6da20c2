#include "cli/mesh_output.hpp"

#include <string>
#include <string_view>
#include <vector>

#include "cli/file_pattern.hpp"
#include "formats/brick_file.hpp"
#include "formats/extension.hpp"
#include "formats/mesh_file.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::cli {
namespace {

MeshFormat format_of(const std::filesystem::path& path) {
    const std::string extension = formats::lower_extension(path);
    std::vector<std::string> extensions;
    for (const MeshFormat format : choices<MeshFormat>) {
        extensions.push_back(std::string(".").append(name_of(format)));
        if (extension == extensions.back()) return format;
    }
    throw InvalidInput(path.string() + ": meshes are written as " +
                       listed(std::vector<std::string_view>(extensions.begin(), extensions.end())) + ", not as '" +
                       extension + "'");
}

}  // namespace

void check_folder(const std::filesystem::path& path) {
    const std::filesystem::path folder = path.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder))
        throw InvalidInput(path.string() + ": cannot be written: there is no folder " + folder.string());
}

void check_mesh_path(const std::filesystem::path& path) {
    format_of(path);
    check_folder(path);
}

void check_points_path(const std::filesystem::path& path) {
    if (formats::lower_extension(path) != ".ply")
        throw InvalidInput(path.string() + ": points are written as .ply, not as '" + formats::lower_extension(path) +
                           "'");
    check_folder(path);
}

void check_spray(const Settings& settings) {
    if (settings.spray != Spray::points)
        throw InvalidInput("--spray-out has nothing to write: spray is '" + std::string(name_of(settings.spray)) +
                           "', and must be '" + std::string(name_of(Spray::points)) + "'");
}

void write_surface(const std::filesystem::path& path, const Surface& surface) {
    switch (format_of(path)) {
        case MeshFormat::ply:
            return formats::write_ply(path, surface.mesh());
        case MeshFormat::obj:
            return formats::write_obj(path, surface.mesh());
        case MeshFormat::bricks:
            return formats::write_bricks(path, surface.encoded());
    }
}

std::filesystem::path frame_path(const std::filesystem::path& directory, std::uint64_t index,
                                 std::string_view extension) {
    return FilePattern((directory / ("frame_{:06}." + std::string(extension))).string()).at(index);
}

}  // namespace meniscus::cli
