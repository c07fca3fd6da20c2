// A server's figures of a frame.
#pragma once

#include <cstdint>

#include "meniscus/statistics.hpp"

namespace meniscus::client {

/// The server's figures of one frame, beside the reconstruction's own.
struct FrameStatistics : Statistics {
    double encode_seconds = 0.0;
    double latency_seconds = 0.0;
    std::uint64_t encoded_bytes = 0;

    /// The server's own figures alone.
    template <class Visit>
    static void rows(const Visit& visit) {
        using F = FrameStatistics;
        visit("encode_seconds", &F::encode_seconds, {.help = "time of the encoding", .unit = "s"});
        visit("latency_seconds", &F::latency_seconds,
              {.help = "time from the frame's last byte to the end of its encoding", .unit = "s"});
        visit("encoded_bytes", &F::encoded_bytes, {.help = "all bricks as sent", .unit = "bytes"});
    }
};

}  // namespace meniscus::client
