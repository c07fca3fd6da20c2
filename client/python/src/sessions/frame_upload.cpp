#include "sessions/frame_upload.hpp"

#include <limits>
#include <string>

#include "meniscus/error.hpp"

namespace meniscus::python {

std::uint64_t RisingIndex::next(std::optional<std::uint64_t> given) const {
    if (last_ == std::numeric_limits<std::uint64_t>::max())
        throw InvalidInput("the last frame's index is " + std::to_string(*last_) +
                           ", and none is greater: open another stream");
    const std::uint64_t least = last_ ? *last_ + 1 : 0;
    if (given && *given < least)
        throw InvalidInput("index is " + std::to_string(*given) + ", must be at least " + std::to_string(least) +
                           ": it rises from frame to frame");
    return given.value_or(least);
}

}  // namespace meniscus::python
