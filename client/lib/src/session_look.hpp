// Looks for a session, with the server that its calls go to now.
#pragma once

#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include <chrono>
#include <string>

#include "connection/connection.hpp"
#include "meniscus/v1/session_service.pb.h"

namespace meniscus::client {

/// Waits for the connection, no longer than to `give_up_at`. Somebody has to wait for it in gRPC: it looks after a
/// connection that no call waits for every five seconds only. An attempt ends after five seconds at the latest, so that
/// a network that swallows packets does not hold the others up.
void wait_for_connection(grpc::ClientContext& context, std::chrono::steady_clock::time_point give_up_at);

/// The context gets the metadata.
grpc::Status get_session(const Connection& connection, grpc::ClientContext& context, const std::string& session_id,
                         v1::Session& session);

}  // namespace meniscus::client
