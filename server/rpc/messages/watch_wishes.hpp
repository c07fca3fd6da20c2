// A watcher's wishes, from the wire.
#pragma once

#include "meniscus/settings.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/watching/watch_wishes.hpp"

namespace meniscus::server {

/// Wishes that amount to the same mesh in a session of these settings become equal formats. Throws InvalidInput for a
/// wish out of range.
WatchWishes watch_wishes_of(const v1::WatchRequest& request, const Settings& settings);
WatchWishes watch_wishes_of(const v1::SnapshotRequest& request, const Settings& settings);
WatchWishes watch_wishes_of(const v1::WatchParticlesRequest& request, const Settings& settings);

}  // namespace meniscus::server
