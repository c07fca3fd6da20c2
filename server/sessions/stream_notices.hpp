// Messages to a simulator that are no frames.
#pragma once

#include <chrono>

#include "sessions/dropped_frame.hpp"
#include "sessions/encoded_frame.hpp"

namespace meniscus::server {

/// The frame will not be answered.
SharedMessage frame_dropped_message(const DroppedFrame& frame);
/// The server goes down, and ends the call after this time whatever is left. To watchers too.
SharedMessage draining_message(std::chrono::duration<double> grace);

}  // namespace meniscus::server
