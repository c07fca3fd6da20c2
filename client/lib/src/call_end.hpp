// The end of a call: which server ended it, and whether another call is worth while.
#pragma once

#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include <string>

namespace meniscus::client {

/// The instance of the server that has accepted a call which goes on. Empty: none has, or one of an older version.
std::string accepted_by(const grpc::ClientContext& context);

/// The instance of the server that the status is from. Empty: it is a proxy's, gRPC's, or that of a server of an older
/// version.
std::string ended_by(const grpc::ClientContext& context);

/// Whether the call broke, or was ended by a server that goes down or has seen the session move: another call may go
/// on.
bool can_reconnect_after(const grpc::Status& status, const grpc::ClientContext& context);

/// Why the session of a watcher's call ended, in words. Empty: it has not, or the server is of an older version.
std::string session_end_of(const grpc::ClientContext& context);

/// Whether the server has ended a stream because nothing came over it for too long.
bool ended_for_idleness(const grpc::ClientContext& context);

}  // namespace meniscus::client
