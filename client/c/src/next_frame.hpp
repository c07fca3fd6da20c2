// The wait for a frame, of sessions and watchers.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "frame.hpp"
#include "meniscus/error.hpp"
#include "result.hpp"

namespace meniscus::c {

/// Source: a stream or a watcher. timeout_seconds below 0: for as long as it takes.
template <class Source>
meniscus_result next_frame(Source& source, double timeout_seconds, meniscus_frame** frame) {
    required(frame, "frame") = nullptr;
    if (std::isnan(timeout_seconds)) throw InvalidInput("timeout_seconds is nan, must be a number");
    std::optional<client::ReceivedFrame> received;
    if (timeout_seconds < 0.0) {
        received = source.next();
    } else {
        constexpr double most = 1e6;  // as good as for ever, and far within the range of clocks
        const std::chrono::duration<double> seconds(std::min(timeout_seconds, most));
        auto next = source.next(std::chrono::ceil<std::chrono::milliseconds>(seconds));
        if (!next && !next.ended) return MENISCUS_NOTHING_YET;
        received = std::move(next.frame);
    }
    if (!received) return MENISCUS_ENDED;
    *frame = new meniscus_frame{*std::move(received)};
    return MENISCUS_OK;
}

}  // namespace meniscus::c
