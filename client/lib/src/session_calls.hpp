// The calls about one session, and what sessions are on the wire.
#pragma once

#include <chrono>
#include <string>

#include "connection/connection.hpp"
#include "meniscus/client/session_info.hpp"
#include "meniscus/v1/session_service.pb.h"
#include "unary_call.hpp"

namespace meniscus::client {

/// The calls of Client about a session. They throw the error that the call failed with.
v1::CreateSessionResponse create_session(const Connection& connection, const std::string& id, const Settings& settings,
                                         const SessionOptions& options, const CallLimits& limits);
SessionInfo session_info(const Connection& connection, const std::string& id, const CallLimits& limits);
void delete_session(const Connection& connection, const std::string& id, const DeleteOptions& options,
                    const CallLimits& limits);

SessionInfo from_wire(const v1::Session& wire);
/// Microseconds since 1970.
std::chrono::system_clock::time_point time_from_wire(std::int64_t microseconds);

}  // namespace meniscus::client
