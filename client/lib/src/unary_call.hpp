// A call that is answered once.
#pragma once

#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include <chrono>
#include <string>

#include "connection/connection.hpp"
#include "connection/deadline.hpp"
#include "error_mapping.hpp"

namespace meniscus::client {

/// Of a call that the server has not answered in time.
grpc::Status not_answered(std::chrono::milliseconds timeout);

/// About a session, or (no id) about none. Throws what it failed with, also when there is no answer within `timeout`.
template <class Stub, class Request, class Response>
void call(const Connection& connection, Stub& stub,
          grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*), const std::string& session_id,
          const Request& request, Response& response, std::chrono::milliseconds timeout) {
    grpc::ClientContext context;
    connection.add_metadata(context, session_id);
    context.set_deadline(deadline_after<std::chrono::system_clock>(timeout));
    const grpc::Status status = (stub.*method)(&context, request, &response);
    const bool late = status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
    require_ok(late ? not_answered(timeout) : status, connection.address);
}

}  // namespace meniscus::client
