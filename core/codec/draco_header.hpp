// What a Draco mesh claims of itself, before anybody believes it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace meniscus {

/// Draco allocates by these counts before it looks at what follows them.
struct DracoHeader {
    std::uint64_t vertices = 0;  ///< of the connectivity: points that share a position may be several
    std::uint64_t faces = 0;
    std::uint64_t symbols = 0;  ///< of the edgebreaker traversal, one per face at most
    std::uint64_t split_symbols = 0;
    unsigned attribute_connectivities = 0;  ///< beside the positions'
};

/// None unless the bytes begin as what encode_brick() makes: bitstream 2.2, a mesh, edgebreaker, no metadata.
std::optional<DracoHeader> read_draco_header(std::span<const std::byte> bytes);

}  // namespace meniscus
