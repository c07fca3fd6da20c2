// The claims of a Draco mesh about itself, before they are believed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace meniscus {

/// Draco allocates by these counts before it looks at the bytes behind them.
struct DracoHeader {
    std::uint64_t vertices = 0;  ///< vertices of the connectivity: several points may share a position
    std::uint64_t faces = 0;
    std::uint64_t symbols = 0;  ///< symbols of the edgebreaker traversal, one per face at most
    std::uint64_t split_symbols = 0;
    unsigned attribute_connectivities = 0;  ///< number of connectivities beside the positions'
};

/// None unless the bytes begin like those that encode_brick() makes: bitstream 2.2, a mesh, edgebreaker, no metadata.
std::optional<DracoHeader> read_draco_header(std::span<const std::byte> bytes);

}  // namespace meniscus
