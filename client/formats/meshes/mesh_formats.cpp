#include "formats/meshes/mesh_formats.hpp"

#include <vector>

#include "formats/bytes/extension.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {

std::span<const std::string_view> mesh_extensions() {
    static constexpr auto all = [] {
        std::array<std::string_view, mesh_formats.size()> extensions;
        for (std::size_t i = 0; i < extensions.size(); ++i) extensions[i] = mesh_formats[i].extension;
        return extensions;
    }();
    return all;
}

std::span<const std::string_view> read_mesh_formats() {
    static const std::vector<std::string_view> read = [] {
        std::vector<std::string_view> names;
        for (const MeshFormatRow& row : mesh_formats)
            if (row.read != nullptr) names.push_back(row.name);
        return names;
    }();
    return read;
}

MeshFormat mesh_format_of(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    for (const MeshFormatRow& row : mesh_formats)
        if (row.extension == extension) return row.format;
    throw InvalidInput(path.string() + ": mesh files end in " + listed(mesh_extensions()) + ", not in '" + extension +
                       "'");
}

}  // namespace meniscus::formats
