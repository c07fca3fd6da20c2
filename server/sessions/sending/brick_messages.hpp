// A brick as the messages that carry it, and back.
#pragma once

#include <array>
#include <cstdint>

#include "meniscus/brick_coding.hpp"
#include "sessions/sending/encoded_frame.hpp"

namespace meniscus::server {

SharedBrick brick_messages(const EncodedBrick& brick, const ContentHash& content_hash);

/// The brick that the messages carry.
EncodedBrick encoded_brick(const BrickMessages& messages);

/// The earlier frame's brick at this place; none if there was none. bricks: ordered by place.
SharedBrick find_brick(const std::vector<SharedBrick>& bricks, const std::array<std::int32_t, 3>& place);

}  // namespace meniscus::server
