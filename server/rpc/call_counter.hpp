// Counts the calls that end, by their status.
#pragma once

#include <grpcpp/support/server_interceptor.h>

#include <memory>

#include "sessions/metrics.hpp"

namespace meniscus::server {

/// Sees every call of every service, whether the server or the client ends it.
std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> make_call_counter(
    std::shared_ptr<Metrics> metrics);

}  // namespace meniscus::server
