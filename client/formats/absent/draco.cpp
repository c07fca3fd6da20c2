// A build without Draco.
#include "formats/meshes/glb_draco.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {

void add_draco(const std::vector<files::GlbVertices>& /*all*/, const files::GlbBounds& /*bounds*/,
               const std::vector<Triangle>& /*triangles*/, files::GlbDocument& /*document*/) {
    throw NotBuilt("a compressed .glb",
                   "Draco: write it uncompressed, or build it where libdraco-dev 1.5 is installed");
}

}  // namespace meniscus::formats
