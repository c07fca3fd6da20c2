// A server's figures of a frame.
#pragma once

#include <cstdint>

#include "meniscus/statistics.hpp"

namespace meniscus::client {

/// The server's figures of one frame, beside the reconstruction's own.
struct FrameStatistics : Statistics {
    double encode_seconds = 0.0;
    double latency_seconds = 0.0;  ///< from the frame's last byte to the end of its encoding
    std::uint64_t encoded_bytes = 0;
};

}  // namespace meniscus::client
