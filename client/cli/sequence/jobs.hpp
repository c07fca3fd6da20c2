// How many frames of a sequence are reconstructed at a time.
#pragma once

#include <cstdint>
#include <optional>

namespace meniscus::cli {

/// The work to be done, and the machine that does it.
struct JobsInput {
    std::size_t frames = 0;
    unsigned threads = 1;            ///< of this process, at least 1
    std::uint64_t file_bytes = 0;    ///< of the largest input
    std::uint64_t memory_bytes = 0;  ///< of the machine
};

/// given: the number that was asked for. Without it: as many as there are threads, at most 8, and no more than fit into
/// half of the memory. At least 1, and never more than there are frames.
unsigned jobs_of(const JobsInput& input, std::optional<unsigned> given);

}  // namespace meniscus::cli
