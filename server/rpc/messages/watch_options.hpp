// A watcher's options, from the wire.
#pragma once

#include "meniscus/settings.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/watching/watch_options.hpp"

namespace meniscus::server {

/// Options that amount to the same mesh in a session of these settings become equal formats, but for the codec:
/// see codec_choice(). Throws InvalidInput for an option out of range.
WatchOptions watch_options_of(const v1::WatchRequest& request, const Settings& settings);
WatchOptions watch_options_of(const v1::SnapshotRequest& request, const Settings& settings);
WatchOptions watch_options_of(const v1::WatchParticlesRequest& request, const Settings& settings);

}  // namespace meniscus::server
