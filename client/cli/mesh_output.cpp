#include "cli/mesh_output.hpp"

#include "cli/file_pattern.hpp"
#include "formats/brick_file.hpp"
#include "formats/extension.hpp"
#include "formats/mesh_file.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {

void check_folder(const std::filesystem::path& path) {
    const std::filesystem::path folder = path.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder))
        throw InvalidInput(path.string() + ": cannot be written: there is no folder " + folder.string());
}

void check_mesh_path(const std::filesystem::path& path) {
    const std::string extension = formats::lower_extension(path);
    if (extension != ".ply" && extension != ".obj" && extension != ".bricks")
        throw InvalidInput(path.string() + ": meshes are written as .ply, .obj or .bricks, not as '" + extension + "'");
    check_folder(path);
}

void write_surface(const std::filesystem::path& path, const Surface& surface) {
    const std::string extension = formats::lower_extension(path);
    if (extension == ".bricks")
        formats::write_bricks(path, surface.encoded());
    else if (extension == ".obj")
        formats::write_obj(path, surface.mesh());
    else
        formats::write_ply(path, surface.mesh());
}

std::filesystem::path frame_path(const std::filesystem::path& directory, std::uint64_t index,
                                 const std::string& extension) {
    return FilePattern((directory / ("frame_{:06}." + extension)).string()).at(index);
}

}  // namespace meniscus::cli
