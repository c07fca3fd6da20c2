// RecordingService.ListRecordings.
#pragma once

#include "meniscus/v1/recording_service.pb.h"
#include "recording/recording_catalog.hpp"
#include "security/authorizer.hpp"

namespace meniscus::server {

/// The recordings that the caller may see. Blocks on the disk.
v1::ListRecordingsResponse list_recordings(RecordingCatalog& catalog, const Caller& caller);

}  // namespace meniscus::server
