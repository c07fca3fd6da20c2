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
/// manifest has no room for. keep_seconds: none: all are needed; segments: by index, the oldest first; seconds_of: of
/// one.
template <class Segments, class SecondsOf>
std::size_t segments_beyond(const Segments& segments, std::optional<double> keep_seconds, const SecondsOf& seconds_of) {
    const std::size_t most = std::min<std::size_t>(segments.size(), max_segments);
    if (!keep_seconds) return segments.size() - most;
    double newer = 0.0;
    std::size_t kept = 0;
    while (kept < most && newer < *keep_seconds) newer += seconds_of(segments[segments.size() - ++kept]);
    return segments.size() - kept;
}

}  // namespace meniscus::files
