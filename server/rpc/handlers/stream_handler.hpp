// SurfaceService.Stream and Publish: frames of particles or of finished bricks in, meshes and statistics out.
#pragma once

#include <grpcpp/server_context.h>

#include "rpc/calls/active_calls.hpp"
#include "rpc/calls/byte_service.hpp"
#include "rpc/calls/refusals.hpp"
#include "security/authorizer.hpp"
#include "sessions/session/session_registry.hpp"

namespace meniscus::server {

/// The call's reactor, which owns itself until the call is done. Request: v1::StreamRequest or v1::PublishRequest.
template <class Request>
ByteReactor* start_stream(SessionRegistry& registry, const Authorizer& authorizer, Refusals& refusals,
                          ActiveCalls& calls, grpc::CallbackServerContext& context);

}  // namespace meniscus::server
