// The connections of the gRPC port.
#pragma once

#include <prometheus/metric_family.h>

#include <vector>

#include "connections/grpc_port.hpp"

namespace meniscus::server {

std::vector<prometheus::MetricFamily> connection_metrics(const GrpcPort::Counts& counts);

}  // namespace meniscus::server
