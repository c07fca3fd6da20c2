// Counters of the recordings.
#pragma once

#include <prometheus/metric_family.h>

#include <vector>

#include "recording/recording_writer.hpp"

namespace meniscus::server {

std::vector<prometheus::MetricFamily> recording_metrics(const RecordingCounters& counters, std::uint32_t readers);

}  // namespace meniscus::server
