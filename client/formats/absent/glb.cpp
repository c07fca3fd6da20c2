// A build without nlohmann-json, which writes the text of .glb.
#include "formats/meshes/glb_writer.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {

std::string to_glb(const TriangleMesh& /*mesh*/, GlbCoding /*coding*/) {
    throw NotBuilt("glTF (.glb)", "nlohmann-json: build it where nlohmann-json3-dev is installed");
}

void write_glb(const std::filesystem::path& /*path*/, const TriangleMesh& mesh, const MeshWriting& /*writing*/) {
    to_glb(mesh);
}

}  // namespace meniscus::formats
