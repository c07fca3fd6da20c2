#include "cli/sequence/jobs.hpp"

#include <algorithm>

namespace meniscus::cli {
namespace {

/// A frame scales to about eight threads: with more, every frame has several.
constexpr unsigned default_jobs = 8;
/// Memory that a frame takes, from its file to its mesh, for each byte of its file. Frame 040 of the dam break has 40
/// bytes a particle and takes 60 at the default cell size; raw float32 triples have 12.
constexpr std::uint64_t bytes_per_file_byte = 200;

}  // namespace

unsigned jobs_of(const JobsInput& input, std::optional<unsigned> given) {
    std::uint64_t jobs = given.value_or(std::min(default_jobs, input.threads));
    if (!given && input.file_bytes > 0)
        jobs = std::min(jobs, input.memory_bytes / 2 / bytes_per_file_byte / input.file_bytes);
    return static_cast<unsigned>(std::clamp<std::uint64_t>(jobs, 1, std::max<std::uint64_t>(input.frames, 1)));
}

}  // namespace meniscus::cli
