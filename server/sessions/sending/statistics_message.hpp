// A frame's statistics as they go out.
#pragma once

#include "meniscus/v1/mesh.pb.h"
#include "sessions/sending/frame_statistics.hpp"

namespace meniscus::server {

v1::FrameStatistics statistics_message(const FrameStatistics& statistics);

}  // namespace meniscus::server
