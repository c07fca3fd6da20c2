// Positions in messages: as many bits as their differences take, where twelve bytes were.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "parts/message.hpp"

namespace meniscus {

/// A position takes less as a rule, with its share of what is said of a group, and at most twelve with it.
inline constexpr std::size_t packed_position_bytes = 9;

/// Adds positions, x y z each, that snap() to the same units once they are read: what is reconstructed of them is the
/// same. places: of those that are sent, if there are any; without
/// places, all are.
void add_positions(MessageWriter& message, std::span<const float> positions, std::span<const std::uint32_t> places,
                   double units_per_length);
/// Appends them. Throws InvalidInput where the message is none of this program's.
void append_positions(MessageReader& message, std::vector<float>& positions);

}  // namespace meniscus
