// A frame as it goes out: immutable messages, shared by all who receive it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace meniscus::server {

/// One StreamResponse, which is a WatchResponse byte for byte, in protobuf's wire format.
using SharedMessage = std::shared_ptr<const std::string>;

/// A whole mesh with its statistics: MeshBegin, the bricks, FrameStatistics.
struct EncodedFrame {
    std::uint64_t frame_index = 0;
    std::vector<SharedMessage> messages;
};

}  // namespace meniscus::server
