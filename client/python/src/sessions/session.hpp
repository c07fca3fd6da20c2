// Sessions as Python sees them.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <mutex>
#include <stop_token>
#include <string>
#include <utility>

#include "meniscus/client/errors.hpp"
#include "meniscus/client/session.hpp"

namespace meniscus::python {

/// The class _meniscus.Session. Several threads may use it, in turn.
class HeldSession {
public:
    explicit HeldSession(client::Session&& session) : session_(std::move(session)) {}

    const std::string& id() const noexcept { return session_.id(); }
    /// call(session), in its turn. Throws ServerError (canceled) where a stop is requested before.
    template <class Call>
    auto in_turn(const std::stop_token& stop, const Call& call) {
        std::unique_lock turn(turn_, std::defer_lock);
        while (!turn.try_lock_for(std::chrono::milliseconds(50)))
            if (stop.stop_requested())
                throw client::ServerError("the call was canceled while it waited for one in another thread",
                                          client::ErrorCode::canceled);
        return call(session_);
    }

private:
    client::Session session_;
    std::timed_mutex turn_;
};

}  // namespace meniscus::python
