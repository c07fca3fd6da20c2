// gRPC statuses to exceptions.
#pragma once

#include <grpcpp/support/status.h>

#include <exception>
#include <string>

namespace meniscus::client {

/// The exception for a failed call: InvalidInput, LimitExceeded or ServerError. The status is not OK.
std::exception_ptr to_exception(const grpc::Status& status, const std::string& address);

/// Throws it, unless the status is OK.
void require_ok(const grpc::Status& status, const std::string& address);

}  // namespace meniscus::client
