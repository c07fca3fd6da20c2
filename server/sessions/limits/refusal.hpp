// Refusals that are neither bad input nor a limit: the request does not fit the state of the server.
#pragma once

#include <stdexcept>
#include <string>

#include "sessions/limits/limit_reached.hpp"

namespace meniscus::server {

class Refusal : public std::runtime_error {
public:
    enum class Kind {
        not_found,
        already_exists,
        failed_precondition,
        unavailable,
        unauthenticated,
        permission_denied,
        unimplemented,
        data_loss,
        aborted  ///< another call, which has ended, takes this one along
    };

    Refusal(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
    Kind kind() const noexcept { return kind_; }

private:
    Kind kind_;
};

/// Ends a stream that brings nothing. A client may open it again when it has a frame.
class IdleStream : public LimitReached {
public:
    explicit IdleStream(const std::string& message) : LimitReached(LimitName::idle_time, message) {}
};

/// reason: for people; empty: unknown.
inline Refusal session_ended(const std::string& id, const std::string& reason) {
    return {Refusal::Kind::not_found, "session " + id + " has ended" + (reason.empty() ? "" : ": " + reason)};
}

inline Refusal moved() {
    return {Refusal::Kind::unavailable, "the session has moved to another server: call again"};
}

inline Refusal shutting_down() {
    return {Refusal::Kind::unavailable, "the server is shutting down"};
}

}  // namespace meniscus::server
