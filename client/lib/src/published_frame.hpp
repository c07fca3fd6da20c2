// A frame of finished bricks that was pushed and not yet answered.
#pragma once

#include "byte_pool.hpp"
#include "meniscus/client/received_frame.hpp"
#include "pushed_frame.hpp"

namespace meniscus::client {

/// Throws InvalidInput for a time that is not finite.
PushedFrame published_frame(const ReceivedFrame& frame, BytePool& pool);

}  // namespace meniscus::client
