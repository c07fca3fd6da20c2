// What the parts of a session read and none of them changes.
#pragma once

#include <memory>
#include <string>

#include "meniscus/settings.hpp"
#include "sessions/limits/limits.hpp"
#include "sessions/session_observer.hpp"
#include "sessions/shared_resources.hpp"

namespace meniscus::server {

struct SessionIdentity {
    std::string id;
    std::string owner{};  ///< the caller that created it; empty where callers have no names
};

struct SessionContext {
    const SessionIdentity identity;
    const Settings settings;
    const Limits limits;
    const SharedResources shared;
    const std::shared_ptr<SessionObserver> observer;  ///< may be none
};

}  // namespace meniscus::server
