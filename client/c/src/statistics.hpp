// Figures of a frame as the C struct has them.
#pragma once

#include "meniscus/meniscus.h"
#include "meniscus/statistics.hpp"

namespace meniscus::c {

/// The figures for C, without those of a server.
meniscus_statistics to_c(const Statistics& statistics);

}  // namespace meniscus::c
