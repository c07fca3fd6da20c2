// Bricks as Draco meshes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "meniscus/brick_coding.hpp"

namespace meniscus {

/// Throws InvalidInput for a speed out of range, NotBuilt in a build without Draco.
std::vector<std::byte> encode_draco(const BrickContent& content, const CodingOptions& options);

/// origin: of the brick, on the refined lattice. Throws InvalidInput for bytes that are no such brick, NotBuilt in a
/// build without Draco.
DecodedBrick decode_draco(const EncodedBrick& brick, const LatticePosition& origin, std::uint32_t offset_bits,
                          std::span<const CodedAttribute> attributes);

}  // namespace meniscus
