// How long a call of the C interface waits.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "meniscus/error.hpp"

namespace meniscus::c {

/// timeout_seconds below 0: none, for as long as it takes. Throws InvalidInput for a NaN.
inline std::optional<std::chrono::milliseconds> timeout_of(double timeout_seconds) {
    if (std::isnan(timeout_seconds)) throw InvalidInput("timeout_seconds is nan, must be a number");
    if (timeout_seconds < 0.0) return std::nullopt;
    constexpr double most = 1e6;  // as good as for ever, and far within the range of clocks
    const std::chrono::duration<double> seconds(std::min(timeout_seconds, most));
    return std::chrono::ceil<std::chrono::milliseconds>(seconds);
}

}  // namespace meniscus::c
