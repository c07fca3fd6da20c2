// The kernel's figures of this process, under the names that Prometheus' own client libraries use.
#pragma once

#include <prometheus/metric_family.h>

#include <vector>

namespace meniscus::server {

/// Figures that the kernel does not give are left out.
std::vector<prometheus::MetricFamily> process_metrics();

}  // namespace meniscus::server
