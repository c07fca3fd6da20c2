// Exceptions to gRPC statuses.
#pragma once

#include <grpcpp/support/status.h>

#include <exception>

namespace meniscus::server {

/// None: OK. A GPU that failed is INTERNAL, and so is what is not a refusal: a defect, which is logged.
grpc::Status to_status(const std::exception_ptr& error);

}  // namespace meniscus::server
