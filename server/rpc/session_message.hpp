// A session as clients see it.
#pragma once

#include "meniscus/v1/session_service.pb.h"
#include "sessions/session.hpp"

namespace meniscus::server {

v1::Session session_message(const Session& session);

}  // namespace meniscus::server
