// The figures of a frame as a message.
#pragma once

#include "meniscus/statistics.hpp"
#include "pushing/wire_message.hpp"

namespace meniscus::pushing {

/// FrameStatistics (proto/meniscus/v1/mesh.proto), but for what a server measures and for the frame's index and time.
Message statistics_message(const Statistics& statistics);

}  // namespace meniscus::pushing
