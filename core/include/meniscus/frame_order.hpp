// The rule that frames of a simulation follow each other by.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "meniscus/error.hpp"

namespace meniscus {

/// Throws InvalidInput for an index that is not above the one before (none: it is the first), and for a simulation time
/// that is not finite.
inline void require_frame_order(std::optional<std::uint64_t> before, std::uint64_t index, double simulation_time) {
    if (before && index <= *before)
        throw InvalidInput("frame index " + std::to_string(index) + " after " + std::to_string(*before) +
                           "; indices must increase");
    if (!std::isfinite(simulation_time))
        throw InvalidInput("frame " + std::to_string(index) + ": simulation_time is " +
                           std::to_string(simulation_time) + "; it must be finite");
}

}  // namespace meniscus
