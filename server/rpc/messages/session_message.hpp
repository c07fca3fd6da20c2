// A session as clients see it.
#pragma once

#include "meniscus/v1/session_service.pb.h"
#include "security/tokens.hpp"
#include "sessions/session/session.hpp"

namespace meniscus::server {

/// The session that it waits for is named to admins alone.
v1::Session session_message(const Session& session, const Caller& caller);

}  // namespace meniscus::server
