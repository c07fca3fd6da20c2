// The values that all parts of a session read and none changes.
#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "meniscus/settings.hpp"
#include "meniscus/v1/session_service.pb.h"
#include "sessions/limits/limits.hpp"
#include "sessions/limits/name_account.hpp"
#include "sessions/session/session_observer.hpp"
#include "sessions/session/shared_resources.hpp"

namespace meniscus::server {

/// The description of a session, and when it goes by itself. A client that joins it need not know them.
struct SessionKind {
    v1::SessionDescription description{};
    bool ephemeral = false;       ///< see Session::unused()
    bool stream_follows = false;  ///< its creator is about to open one: where none comes, it has vanished
    bool publish = false;         ///< its meshes, as files of the HTTP port
};

struct SessionIdentity {
    std::string id;
    std::string owner{};                     ///< the caller that created it; empty where callers have no names
    std::shared_ptr<NameAccount> account{};  ///< that caller's; none: it has no limits of its own
    SessionKind kind{};
};

struct SessionContext {
    const SessionIdentity identity;
    const Settings settings;
    const Limits limits;
    const SharedResources shared;
    const SessionObservers observers{};
    const std::stop_token closing{};  ///< requested once the session ends
};

}  // namespace meniscus::server
