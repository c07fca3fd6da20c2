// Encoded bricks on the wire, where large ones travel in parts.
#pragma once

#include <vector>

#include "meniscus/brick_coding.hpp"
#include "meniscus/v1/mesh.pb.h"

namespace meniscus::conversion {

/// The brick in parts of at most 1 MiB, in their order.
std::vector<v1::MeshBrick> to_wire(const EncodedBrick& brick);

/// Adds a part behind those before; the first one makes the brick. Throws InvalidInput for a codec that this version
/// does not know. Whether parts belong together is the caller's to know.
void append_part(const v1::MeshBrick& part, EncodedBrick& brick);

}  // namespace meniscus::conversion
