// From the frame that a caller has to the next one.
#pragma once

#include "meniscus/client/client.hpp"

namespace meniscus::client {

/// Sets the frame's changed and vanished places, against the bricks of the frame before. Bricks are compared by
/// identity: those that were not received anew are shared by both frames.
void find_changes(const std::vector<std::shared_ptr<const EncodedBrick>>& before, ReceivedFrame& frame);

}  // namespace meniscus::client
