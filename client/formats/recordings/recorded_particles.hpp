// A recorded frame's messages to its particles.
#pragma once

#include "files/random_access_file.hpp"
#include "formats/recordings/recording.hpp"

namespace meniscus::formats {

/// Throws InvalidInput, in one line that names file and frame, unless the messages are exactly that frame.
RecordedParticles read_recorded_particles(const files::RandomAccessFile& file, const RecordedFrame& frame);

}  // namespace meniscus::formats
