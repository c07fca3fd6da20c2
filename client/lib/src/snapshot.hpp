// The call that receives a session's newest mesh.
#pragma once

#include <optional>
#include <string>

#include "connection/connection.hpp"
#include "meniscus/client/received_frame.hpp"
#include "meniscus/client/watcher.hpp"

namespace meniscus::client {

/// Does the work of Client::snapshot().
std::optional<ReceivedFrame> take_snapshot(const Connection& connection, const std::string& session_id,
                                           const SnapshotOptions& options);

}  // namespace meniscus::client
