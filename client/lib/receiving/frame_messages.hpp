// A received frame as the messages that it came in, for files.
#pragma once

#include <google/protobuf/message_lite.h>

#include <functional>

#include "meniscus/client/received_frame.hpp"

namespace meniscus::client {

/// Takes StreamResponse messages, which serve for WatchResponse, too.
using TakeMessage = std::function<void(const google::protobuf::MessageLite&)>;

/// The frame as a difference to `base`, where that saves bricks, or whole. base: the frame before; null: there is none.
/// Bricks of equal bytes are not given again.
void give_messages(const ReceivedFrame& frame, const ReceivedFrame* base, const TakeMessage& take);

}  // namespace meniscus::client
