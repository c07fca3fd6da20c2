#include "formats/mesh_format.hpp"

#include <array>
#include <string>

#include "formats/extension.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::formats {

namespace {

constexpr std::array<std::string_view, 8> extensions_of_meshes{".ply", ".obj", ".bricks", ".vtk",
                                                               ".vtp", ".npz", ".glb",    ".usda"};
static_assert(extensions_of_meshes.size() == choices<MeshFormat>.size());

}  // namespace

std::span<const std::string_view> mesh_extensions() {
    return extensions_of_meshes;
}

std::span<const std::string_view> read_mesh_formats() {
    static_assert(names<MeshFormat>[6] == "glb" && names<MeshFormat>[7] == "usda");
    return std::span(names<MeshFormat>).first(6);
}

MeshFormat mesh_format_of(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    for (const MeshFormat format : choices<MeshFormat>)
        if (extension == mesh_extensions()[static_cast<std::size_t>(format)]) return format;
    throw InvalidInput(path.string() + ": mesh files end in " + listed(mesh_extensions()) + ", not in '" + extension +
                       "'");
}

}  // namespace meniscus::formats
