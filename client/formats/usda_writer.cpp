#include "formats/mesh_file.hpp"
#include "formats/standard_streams.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {

void write_usda(const std::filesystem::path& path, const TriangleMesh&) {
    throw InvalidInput(output_name(path) + ": USDA is not written yet");
}

}  // namespace meniscus::formats
