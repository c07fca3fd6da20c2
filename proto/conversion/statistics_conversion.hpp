// A reconstruction's figures on the wire and in core.
#pragma once

#include <cstddef>

#include "meniscus/statistics.hpp"
#include "meniscus/v1/mesh.pb.h"

namespace meniscus::conversion {

/// Sets what core measures; the server's own figures (index, times of encoding, bytes) are left alone.
void to_wire(const Statistics& statistics, v1::FrameStatistics& wire);

/// The most characters of a warning's text.
inline constexpr std::size_t max_warning_characters = 500;
/// Warnings are bounded, and their texts printable lines, whatever the other side sends.
Statistics from_wire(const v1::FrameStatistics& wire);

}  // namespace meniscus::conversion
