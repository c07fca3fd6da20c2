#include <vector>

#include "meniscus/client/client.hpp"

namespace meniscus::client {

Mesh ReceivedFrame::mesh() const {
    std::vector<DecodedBrick> decoded;
    decoded.reserve(bricks.size());
    for (const auto& brick : bricks) decoded.push_back(decode_brick(*brick, offset_bits));
    Mesh mesh = weld_bricks(decoded, cell_size, offset_bits);
    mesh.spray.assign(spray.begin(), spray.end());
    return mesh;
}

}  // namespace meniscus::client
