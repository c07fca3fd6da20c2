// Messages that carry no frame.
#pragma once

#include <chrono>

#include "sessions/sending/dropped_frame.hpp"
#include "sessions/sending/encoded_frame.hpp"

namespace meniscus::server {

/// The message to a simulator that the frame will not be answered.
SharedMessage frame_dropped_message(const DroppedFrame& frame);
/// For a simulator or a watcher: the server goes down, and ends the call after this time whatever is left.
SharedMessage draining_message(std::chrono::duration<double> grace);

}  // namespace meniscus::server
