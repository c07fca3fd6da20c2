// What the beginning of a recording says of its session.
#pragma once

#include "meniscus/client/session_info.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/v1/recording.pb.h"

namespace meniscus::formats {

/// Throws InvalidInput for settings out of range.
Settings recorded_settings(const v1::RecordingBegin& begin);

/// The session's name, axis and unit; empty where the recording has a name or a unit that no session has.
client::SessionDescription recorded_description(const v1::RecordingBegin& begin);

}  // namespace meniscus::formats
