// Corners of faces in files: untrusted numbers that are to name vertices.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>

#include "formats/bytes/byte_cursor.hpp"

namespace meniscus::formats {

/// A polygon's corner as an index. Throws InvalidInput unless it is one of `count` positions.
inline std::uint32_t to_index(double value, std::size_t count, const ByteCursor& at) {
    if (!(value >= 0.0 && value < static_cast<double>(count)) || value != std::floor(value)) {
        std::ostringstream message;
        message << "a face uses vertex " << value << " of " << count;
        at.fail(message.str());
    }
    return static_cast<std::uint32_t>(value);
}

inline void expect_addressable(std::size_t vertices, const ByteCursor& at) {
    constexpr std::size_t limit = std::numeric_limits<std::uint32_t>::max();
    if (vertices > limit)
        at.fail(std::to_string(vertices) + " vertices; at most " + std::to_string(limit) + " are read");
}

}  // namespace meniscus::formats
