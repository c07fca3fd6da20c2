// Counts the calls, by method and status.
#pragma once

#include <grpcpp/support/server_interceptor.h>
#include <grpcpp/support/status.h>

#include <memory>
#include <string_view>

#include "sessions/sending/metrics.hpp"

namespace meniscus::server {

/// The name of a code in dashboards of gRPC, such as "NotFound".
std::string_view metric_name_of(grpc::StatusCode code);

/// Sees every call of every service, whether the server or the client ends it.
std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> make_call_counter(
    std::shared_ptr<Metrics> metrics);

}  // namespace meniscus::server
