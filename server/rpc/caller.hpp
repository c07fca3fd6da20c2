// The caller of a gRPC call.
#pragma once

#include <grpcpp/server_context.h>

#include "security/authorizer.hpp"

namespace meniscus::server {

/// Asks the authorizer about the call's metadata; throws as it does.
Caller admit(const Authorizer& authorizer, const grpc::ServerContextBase& context, Action action);

}  // namespace meniscus::server
