#include "formats/meshes/mesh_readers.hpp"
#include "formats/recordings/brick_file.hpp"

namespace meniscus::formats {

TriangleMesh read_mesh_bricks(const std::string& name, std::string_view bytes, const ReadLimits& /*limits*/) {
    return to_triangles(read_bricks(name, bytes).mesh());
}

}  // namespace meniscus::formats
