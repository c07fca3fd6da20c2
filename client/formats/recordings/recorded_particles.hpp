// A recorded frame's messages to its particles.
#pragma once

#include <cstdint>
#include <string>

#include "files/random_access_file.hpp"
#include "formats/recordings/recording.hpp"

namespace meniscus::formats {

/// Throws InvalidInput, in one line that names file and frame, unless the messages are exactly that frame.
RecordedParticles read_recorded_particles(const files::RandomAccessFile& file, const RecordedFrame& frame);

/// For the refusal of a frame that never had particles.
inline std::string came_as_bricks(std::uint64_t frame) {
    return "frame " + std::to_string(frame) +
           " came as finished bricks: it has a mesh, which convert writes, and no particles";
}

}  // namespace meniscus::formats
