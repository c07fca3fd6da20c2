// RecordingService.ReadRecording: recorded meshes, as they were sent.
#pragma once

#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include "recording/recording_reads.hpp"
#include "rpc/active_calls.hpp"
#include "security/authorizer.hpp"
#include "sessions/metrics.hpp"

namespace meniscus::server {

/// The call's reactor, which owns itself until the call is done. reads: null where nothing is recorded.
grpc::ServerWriteReactor<grpc::ByteBuffer>* start_reading(RecordingReads* reads, const Authorizer& authorizer,
                                                          Metrics& metrics, ActiveCalls& calls,
                                                          grpc::CallbackServerContext& context,
                                                          const grpc::ByteBuffer& request);

/// Throws Refusal, unimplemented, if there are none.
RecordingReads& require_recorded(RecordingReads* reads);

}  // namespace meniscus::server
