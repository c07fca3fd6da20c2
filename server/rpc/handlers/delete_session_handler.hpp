// SessionService.DeleteSession.
#pragma once

#include "meniscus/v1/session_service.pb.h"
#include "publishing/publications.hpp"
#include "security/authorizer.hpp"
#include "sessions/session/session_registry.hpp"

namespace meniscus::server {

/// publications: null where the server publishes nothing. Throws the error that the call is answered with.
v1::DeleteSessionResponse delete_session(SessionRegistry& registry, Publications* publications, const Caller& caller,
                                         const v1::DeleteSessionRequest& request);

}  // namespace meniscus::server
