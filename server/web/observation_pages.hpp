// The pages for monitoring: /metrics, /healthz, /readyz.
#pragma once

#include <prometheus/metric_family.h>

#include <functional>
#include <vector>

#include "web/router.hpp"

namespace meniscus::server {

/// collect: all metrics of this moment. alive: false if the server has to be started again. ready: false once it takes
/// no new work.
void add_observation_pages(Router& router, std::function<std::vector<prometheus::MetricFamily>()> collect,
                           const std::function<bool()>& alive, std::function<bool()> ready);

}  // namespace meniscus::server
