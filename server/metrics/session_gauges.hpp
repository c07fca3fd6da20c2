// The state of the sessions, as gauges.
#pragma once

#include <prometheus/metric_family.h>

#include <vector>

#include "sessions/session/session_registry.hpp"

namespace meniscus::server {

/// The values of this moment.
std::vector<prometheus::MetricFamily> session_gauges(SessionRegistry& registry);

}  // namespace meniscus::server
