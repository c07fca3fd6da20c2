#include "formats/recordings/recorded_particles.hpp"

#include "files/delimited_messages.hpp"
#include "formats/recordings/recorded_frame_reader.hpp"

namespace meniscus::formats {

RecordedParticles read_recorded_particles(const files::RandomAccessFile& file, const RecordedFrame& frame) {
    const RecordedRange& range = frame.particles;
    files::DelimitedMessages messages(file, range.first, range.first + range.size);
    RecordedParticles particles;
    RecordedFrameReader(messages, {frame.index, frame.particle_count, range.size}).read(particles);
    return particles;
}

}  // namespace meniscus::formats
