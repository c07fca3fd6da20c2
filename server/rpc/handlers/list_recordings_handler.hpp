// RecordingService.ListRecordings.
#pragma once

#include "meniscus/v1/recording_service.pb.h"
#include "recording/recording_catalog.hpp"
#include "security/authorizer.hpp"

namespace meniscus::server {

/// The recordings that the caller may see, the newest first, 4096 at most.
v1::ListRecordingsResponse list_recordings(const RecordingCatalog::Entries& recordings, const Caller& caller);

}  // namespace meniscus::server
