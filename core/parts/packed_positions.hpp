// Positions in messages: as many bits as their differences take, where twelve bytes were.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "parts/message.hpp"

namespace meniscus {

/// Bytes to set aside for a position in a message. Most take less; those that lie far apart take up to twelve.
inline constexpr std::size_t packed_position_bytes = 9;

/// Adds positions, x y z each, world units, that snap() to the same units of the lattice once they are read: what is
/// reconstructed of them is the same. places: of those that are sent; without places all are.
/// units_per_length: that of the frame's settings (particles/positions.hpp).
void add_positions(MessageWriter& message, std::span<const float> positions, std::span<const std::uint32_t> places,
                   double units_per_length);
/// Appends them. Throws InvalidInput where the message is none of this program's.
void append_positions(MessageReader& message, std::vector<float>& positions);

}  // namespace meniscus
