#include "formats/mesh_file.hpp"
#include "formats/standard_streams.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {

void write_glb(const std::filesystem::path& path, const TriangleMesh&) {
    throw InvalidInput(output_name(path) + ": GLB is not written yet");
}

}  // namespace meniscus::formats
