// What all ranks of a run call it by.
#pragma once

#include <cstdint>
#include <string>

#include "ranks.hpp"
#include "run_options.hpp"

namespace meniscus::catalyst {

struct RunName {
    std::string session_id;  ///< a UUID: that of the options, or a new one
    std::uint64_t run = 0;   ///< not 0, with room above it for those that follow
};

/// Drawn by rank 0, for all.
RunName draw_name(const RunOptions& options, const Ranks& ranks);

}  // namespace meniscus::catalyst
