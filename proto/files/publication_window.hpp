// Which segments of a live publication stay.
#pragma once

#include <chrono>
#include <cstddef>

namespace meniscus::files {

/// Time between the manifest's drop of a segment and the removal of its file. A reader may still hold the manifest that
/// lists it.
inline constexpr std::chrono::seconds readers_delay{30};

/// How many of the first segments the newest `keep_seconds` do not need. segments: by index, the oldest first;
/// seconds_of: of one.
template <class Segments, class SecondsOf>
std::size_t segments_beyond(const Segments& segments, double keep_seconds, const SecondsOf& seconds_of) {
    double newer = 0.0;
    std::size_t first = segments.size();
    while (first > 0 && newer < keep_seconds) newer += seconds_of(segments[--first]);
    return first;
}

}  // namespace meniscus::files
