// Figures of a frame as the C struct has them.
#pragma once

#include "meniscus/client/frame_statistics.hpp"
#include "meniscus/meniscus.h"
#include "meniscus/statistics.hpp"

namespace meniscus::c {

/// The figures for C, without those of a server.
meniscus_statistics to_c(const Statistics& statistics);
/// With those of a server.
meniscus_statistics to_c(const client::FrameStatistics& statistics);

}  // namespace meniscus::c
