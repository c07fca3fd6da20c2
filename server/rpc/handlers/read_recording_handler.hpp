// RecordingService.ReadRecording: recorded meshes, as they were sent.
#pragma once

#include <grpcpp/server_context.h>

#include "recording/recording_reads.hpp"
#include "rpc/calls/active_calls.hpp"
#include "rpc/calls/byte_service.hpp"
#include "rpc/calls/refusals.hpp"
#include "security/authorizer.hpp"
#include "sessions/sending/metrics.hpp"

namespace meniscus::server {

/// The call's reactor, which owns itself until the call is done. reads: null where nothing is recorded.
ByteReactor* start_reading(RecordingReads* reads, const Authorizer& authorizer, Refusals& refusals, Metrics& metrics,
                           ActiveCalls& calls, grpc::CallbackServerContext& context);

/// Throws Refusal, unimplemented, if there are none.
RecordingReads& require_recorded(RecordingReads* reads);

}  // namespace meniscus::server
