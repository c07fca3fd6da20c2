#include <vector>

#include "meniscus/client/client.hpp"

namespace meniscus::client {

Mesh ReceivedFrame::mesh() const {
    std::vector<DecodedBrick> decoded;
    decoded.reserve(bricks.size());
    for (const auto& brick : bricks) decoded.push_back(decode_brick(*brick, offset_bits));
    return weld_bricks(decoded, cell_size, offset_bits);
}

}  // namespace meniscus::client
