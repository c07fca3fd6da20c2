// What the kernel knows of this process, under the names that Prometheus' own client libraries give it.
#pragma once

#include <prometheus/metric_family.h>

#include <vector>

namespace meniscus::server {

/// Nothing where the kernel does not tell.
std::vector<prometheus::MetricFamily> process_metrics();

}  // namespace meniscus::server
