#include "formats/mesh_format.hpp"

#include <string>
#include <vector>

#include "formats/extension.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::formats {

MeshFormat mesh_format_of(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    std::vector<std::string> extensions;
    for (const MeshFormat format : choices<MeshFormat>) {
        extensions.push_back(std::string(".").append(name_of(format)));
        if (extension == extensions.back()) return format;
    }
    throw InvalidInput(path.string() + ": mesh files end in " +
                       listed(std::vector<std::string_view>(extensions.begin(), extensions.end())) + ", not in '" +
                       extension + "'");
}

}  // namespace meniscus::formats
