// SessionService.DeleteSession.
#pragma once

#include "meniscus/v1/session_service.pb.h"
#include "security/authorizer.hpp"
#include "sessions/session/session_registry.hpp"

namespace meniscus::server {

/// Throws the error that the call is answered with.
v1::DeleteSessionResponse delete_session(SessionRegistry& registry, const Caller& caller,
                                         const v1::DeleteSessionRequest& request);

}  // namespace meniscus::server
