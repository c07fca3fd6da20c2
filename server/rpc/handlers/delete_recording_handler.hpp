// RecordingService.DeleteRecording.
#pragma once

#include "recording/recording_reads.hpp"
#include "rpc/calls/unary_call.hpp"

namespace meniscus::server {

/// Answers the call, or refuses it, on the thread that reads: no reader begins in the meantime. Throws what is wrong
/// with the request.
void delete_recording(RecordingReads& reads, UnaryCall& call);

}  // namespace meniscus::server
