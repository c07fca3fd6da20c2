// The calls about one session, and what sessions are on the wire.
#pragma once

#include <chrono>
#include <string>

#include "connection/connection.hpp"
#include "meniscus/client/session_info.hpp"
#include "meniscus/v1/session_service.pb.h"

namespace meniscus::client {

/// As Client's; they throw what the call failed with. timeout: for an answer.
v1::CreateSessionResponse create_session(const Connection& connection, const std::string& id, const Settings& settings,
                                         const SessionOptions& options, std::chrono::milliseconds timeout);
SessionInfo session_info(const Connection& connection, const std::string& id, std::chrono::milliseconds timeout);
void delete_session(const Connection& connection, const std::string& id, std::chrono::milliseconds timeout);

SessionInfo from_wire(const v1::Session& wire);
/// Microseconds since 1970.
std::chrono::system_clock::time_point time_from_wire(std::int64_t microseconds);

}  // namespace meniscus::client
