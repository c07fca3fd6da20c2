// Exceptions to gRPC statuses.
#pragma once

#include <grpcpp/support/status.h>

#include <exception>

namespace meniscus::server {

/// OK for no error; INTERNAL for a GPU that failed, and for any exception that is not a refusal: that is a defect, and
/// is logged.
grpc::Status to_status(const std::exception_ptr& error);

/// The status of a call that was canceled: nobody reads it, but it is counted.
grpc::Status client_gone();

}  // namespace meniscus::server
