// The wait for a frame, of sessions and watchers.
#pragma once

#include <optional>
#include <utility>

#include "frame.hpp"
#include "result.hpp"
#include "timeout.hpp"

namespace meniscus::c {

/// Source: a stream or a watcher. timeout_seconds below 0: for as long as it takes.
template <class Source>
meniscus_result next_frame(Source& source, double timeout_seconds, meniscus_frame** frame) {
    required(frame, "frame") = nullptr;
    std::optional<client::ReceivedFrame> received;
    if (const auto timeout = timeout_of(timeout_seconds)) {
        auto next = source.next(*timeout);
        if (!next && !next.ended) return MENISCUS_NOTHING_YET;
        received = std::move(next.frame);
    } else {
        received = source.next();
    }
    if (!received) return MENISCUS_ENDED;
    *frame = new meniscus_frame{*std::move(received)};
    return MENISCUS_OK;
}

}  // namespace meniscus::c
