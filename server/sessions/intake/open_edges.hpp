// Whether bricks that were made elsewhere fit together to a closed surface.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "meniscus/brick_coding.hpp"
#include "meniscus/memory.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::server {

/// The edges of a brick's triangles, from vertex to vertex, that no triangle of the brick has in the other direction.
using OpenEdges = Array<std::array<LatticePosition, 2>>;

/// account, here and below: charged; none: uncounted.
OpenEdges open_edges(const DecodedBrick& brick, const std::shared_ptr<MemoryAccount>& account);

/// Throws InvalidInput, with the place of an edge, unless each open edge has its opposite, as often as it is there: the
/// surface of all bricks is then closed and oriented. mesh: its lattice.
void require_closed(const std::vector<std::shared_ptr<const OpenEdges>>& bricks, const Mesh& mesh,
                    const std::shared_ptr<MemoryAccount>& account);

}  // namespace meniscus::server
