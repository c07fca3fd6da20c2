// Which segments of a live publication stay.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>

#include "files/publication_format.hpp"

namespace meniscus::files {

/// Time between the manifest's drop of a segment and the removal of its file. A reader may still hold the manifest that
/// lists it.
inline constexpr std::chrono::seconds readers_delay{30};

/// How many of the first segments are to leave: those that the newest `keep_seconds` do not need, and those that a
/// manifest has no room for. segments: their number. keep_seconds: none: all are needed. seconds_of: of the one of this
/// number, of which the oldest is 0.
template <class SecondsOf>
std::size_t segments_beyond(std::size_t segments, std::optional<double> keep_seconds, const SecondsOf& seconds_of) {
    const std::size_t most = std::min<std::size_t>(segments, max_segments);
    if (!keep_seconds) return segments - most;
    double newer = 0.0;
    std::size_t kept = 0;
    while (kept < most && newer < *keep_seconds) newer += seconds_of(segments - ++kept);
    return segments - kept;
}

}  // namespace meniscus::files
