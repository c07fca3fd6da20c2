// A call that is answered once.
#pragma once

#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include <chrono>
#include <functional>
#include <stop_token>
#include <string>

#include "connection/connection.hpp"
#include "connection/deadline.hpp"
#include "error_mapping.hpp"

namespace meniscus::client {

/// The status of a call that the server has not answered in time.
grpc::Status not_answered(std::chrono::milliseconds timeout);

/// The limits of a call that is not answered.
struct CallLimits {
    std::chrono::milliseconds timeout;
    std::stop_token stop = {};
};

/// Cancels a call, as long as this lives, when a stop is requested.
class CancelOnStop {
public:
    CancelOnStop(grpc::ClientContext& context, const std::stop_token& stop)
        : callback_(stop, [&context] { context.TryCancel(); }) {}

private:
    std::stop_callback<std::function<void()>> callback_;
};

/// About a session, or (no id) about none. Throws what it failed with, also when there is no answer within the limits.
template <class Stub, class Request, class Response>
void call(const Connection& connection, Stub& stub,
          grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*), const std::string& session_id,
          const Request& request, Response& response, const CallLimits& limits) {
    grpc::ClientContext context;
    connection.add_metadata(context, session_id);
    context.set_deadline(deadline_after<std::chrono::system_clock>(limits.timeout));
    const CancelOnStop cancel_on_stop(context, limits.stop);
    const grpc::Status status = (stub.*method)(&context, request, &response);
    const bool late = status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
    require_ok(late ? not_answered(limits.timeout) : status, connection.address);
}

}  // namespace meniscus::client
