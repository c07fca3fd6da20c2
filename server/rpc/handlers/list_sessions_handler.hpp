// SessionService.ListSessions.
#pragma once

#include "meniscus/v1/session_service.pb.h"
#include "security/authorizer.hpp"
#include "sessions/session/session_registry.hpp"

namespace meniscus::server {

/// Throws the error that the call is answered with.
v1::ListSessionsResponse list_sessions(SessionRegistry& registry, const Caller& caller,
                                       const v1::ListSessionsRequest& request);

}  // namespace meniscus::server
