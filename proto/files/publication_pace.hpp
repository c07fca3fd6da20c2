// The pace of a live publication: when its segments end, and how long its frames are shown.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>

#include "files/publication_format.hpp"
#include "meniscus/seconds.hpp"

namespace meniscus::files {

/// A segment ends this long after its first frame, or after these bytes, whichever comes first.
inline constexpr std::chrono::seconds segment_time{1};
inline constexpr std::size_t segment_bytes = std::size_t{1} << 20;

/// Seconds for which a frame is shown that came so long after the one before; none: it is the first. A pause of the
/// simulator is not one of the viewers.
inline double shown_seconds(std::optional<std::chrono::steady_clock::duration> since_last) {
    return since_last ? std::min(seconds_of(*since_last), seconds_of(segment_time)) : published_frame_seconds;
}

}  // namespace meniscus::files
