// Counters of the publications.
#pragma once

#include <prometheus/metric_family.h>

#include <cstddef>
#include <vector>

#include "publishing/publication.hpp"

namespace meniscus::server {

std::vector<prometheus::MetricFamily> publication_metrics(const PublishingCounters& counters, std::size_t publications);

}  // namespace meniscus::server
