// The caller of a gRPC call.
#pragma once

#include <grpcpp/server_context.h>

#include <string>

#include "security/authorizer.hpp"

namespace meniscus::server {

/// Asks the authorizer about the call's metadata; throws as it does.
Caller admit(const Authorizer& authorizer, const grpc::ServerContextBase& context, Action action);

/// The other end, as gRPC writes it, such as "ipv4:192.0.2.7:50000"; of a call through the HTTP port, the browser's
/// with
/// "(web)" behind it.
std::string peer_of(const grpc::ServerContextBase& context);

}  // namespace meniscus::server
