// The fate of a cell that would cut off a finer neighbor's surface in a sliver at their common face.
#pragma once

#include <cstdint>

namespace meniscus {

enum class Slivers : std::uint8_t {
    raised,  ///< the cell goes up one level: in a reconstruction
    kept,    ///< the crack patterns close the sliver: in tests, so that these patterns meet every case
};

}  // namespace meniscus
