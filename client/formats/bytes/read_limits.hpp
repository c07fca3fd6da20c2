// How much memory the contents of a file may take.
#pragma once

#include <cstdint>

namespace meniscus::formats {

struct ReadLimits {
    /// Most bytes of a file, and of all that it holds once it is decompressed.
    std::uint64_t most_bytes = std::uint64_t{8} << 30;
};

}  // namespace meniscus::formats
