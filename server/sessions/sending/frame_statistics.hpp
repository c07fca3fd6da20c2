// The description and the cost of one frame, in the session and for metrics.
#pragma once

#include <cstdint>

#include "meniscus/statistics.hpp"

namespace meniscus::server {

/// The figures of the reconstruction and those that the session adds. `download_seconds` is that of the mesh that went
/// to the simulator.
struct FrameStatistics : Statistics {
    std::uint64_t frame_index = 0;
    double simulation_time = 0.0;     ///< seconds
    double encode_seconds = 0.0;      ///< wall time; 0 where no mesh was asked for
    double latency_seconds = 0.0;     ///< from the frame's last byte to the end of its encoding
    std::uint64_t encoded_bytes = 0;  ///< of all bricks as sent
};

}  // namespace meniscus::server
