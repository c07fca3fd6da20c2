// How meshes that are made in this process are rounded and encoded.
#pragma once

#include <optional>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/client/normals_by.hpp"
#include "meniscus/codec.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::cli {

struct LocalCoding {
    client::NormalsBy normals_by = client::NormalsBy::server;  ///< receiver: as one would compute them
    /// The normals and the float32 attributes are rounded as those that come from a server; none, or 0 for attributes:
    /// they are not.
    std::optional<int> normal_bits;
    int attribute_bits = 0;
    Codec codec = Codec::lattice_entropy;  ///< of a file of bricks

    /// Rounds a whole mesh; returns how it is encoded.
    CodingOptions round(Mesh& mesh) const;
};

}  // namespace meniscus::cli
