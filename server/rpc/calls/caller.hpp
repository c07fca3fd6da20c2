// The caller of a gRPC call.
#pragma once

#include <grpcpp/server_context.h>

#include <memory>
#include <string>

#include "security/authorizer.hpp"
#include "sessions/session/session_registry.hpp"

namespace meniscus::server {

/// Asks the authorizer about the call's metadata; throws as it does.
Caller admit(const Authorizer& authorizer, const grpc::ServerContextBase& context, Action action);

/// The other end, for the log: as gRPC writes it, such as "ipv4:192.0.2.7:50000", with " (web)" behind it where the
/// call came through the HTTP port. Behind a trusted proxy "192.0.2.7 through " comes first: its client.
std::string peer_of(const Authorizer& authorizer, const grpc::ServerContextBase& context);

/// The caller's account; none if it has no limits of its own.
std::shared_ptr<NameAccount> account_of(const Caller& caller, SessionRegistry& registry);

/// The session, if it exists for the caller. Throws Refusal, not_found, otherwise.
std::shared_ptr<Session> find_session(const Caller& caller, SessionRegistry& registry, const std::string& id,
                                      SessionRegistry::Look look = SessionRegistry::Look::uses_it);

}  // namespace meniscus::server
