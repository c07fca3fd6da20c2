// Gauges that do not change while the server runs: its limits, version and backend.
#pragma once

#include <prometheus/metric_family.h>

#include <vector>

#include "meniscus/reconstructor.hpp"
#include "sessions/limits/limits.hpp"

namespace meniscus::server {

std::vector<prometheus::MetricFamily> limit_gauges(const Limits& limits, const BackendDescription& backend);

}  // namespace meniscus::server
