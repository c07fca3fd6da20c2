#include <vector>

#include "meniscus/client/client.hpp"
#include "meniscus/mesh_normals.hpp"

namespace meniscus::client {

Mesh ReceivedFrame::mesh() const {
    std::vector<DecodedBrick> decoded;
    decoded.reserve(bricks.size());
    for (const auto& brick : bricks) decoded.push_back(decode_brick(*brick, offset_bits, coded_attributes));
    Mesh mesh = weld_bricks(decoded, cell_size, offset_bits);
    if (normals_by == NormalsBy::receiver) compute_normals(mesh);
    if (bricks.empty())
        for (const CodedAttribute& attribute : coded_attributes)
            mesh.attributes.push_back({attribute.name, attribute.type, attribute.components, {}});
    mesh.spray.assign(spray.begin(), spray.end());
    return mesh;
}

}  // namespace meniscus::client
