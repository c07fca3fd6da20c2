// What every decoder of bricks refuses.
#pragma once

#include <cstdint>
#include <string>

#include "meniscus/brick_coding.hpp"

namespace meniscus {

/// Throws InvalidInput, which names the brick.
[[noreturn]] void refuse(const EncodedBrick& brick, const std::string& what);

/// The brick's origin in steps of c / 2^offset_bits. Throws InvalidInput for bits that no mesh has, and for an origin
/// that int32 cannot hold.
LatticePosition brick_origin(const EncodedBrick& brick, std::uint32_t offset_bits);

}  // namespace meniscus
