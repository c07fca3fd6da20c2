// Exceptions to gRPC statuses.
#pragma once

#include <grpcpp/support/status.h>

#include <exception>

namespace meniscus::server {

/// None: OK. What is not a refusal is a defect: INTERNAL, and logged.
grpc::Status to_status(const std::exception_ptr& error);

}  // namespace meniscus::server
