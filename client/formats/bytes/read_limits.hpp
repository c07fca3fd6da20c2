// How much memory the contents of a file may take.
#pragma once

#include <cstdint>

namespace meniscus::formats {

/// Half of the machine's memory, 8 GiB at most.
std::uint64_t usual_most_bytes();

struct ReadLimits {
    /// Most bytes of a file, and of all that it makes grow: what is decompressed, parsed, or made of its numbers.
    std::uint64_t most_bytes = usual_most_bytes();
};

}  // namespace meniscus::formats
