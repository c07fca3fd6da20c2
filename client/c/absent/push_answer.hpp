// The answer of `meniscus push` to one frame.
#pragma once

#include "json_line.hpp"
#include "meniscus/client/frame_statistics.hpp"

namespace meniscus::c {

struct PushAnswer {
    std::uint64_t index = 0;
    double simulation_time = 0.0;        ///< seconds
    client::FrameStatistics statistics;  ///< but for the warnings
};

/// Throws client::ServerError (data_loss) for a line that answers no frame.
PushAnswer read_answer(const JsonLine& line);

}  // namespace meniscus::c
