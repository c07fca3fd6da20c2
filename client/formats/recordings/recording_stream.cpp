#include "formats/recordings/recording_stream.hpp"

#include <cmath>

#include "files/brick_file_format.hpp"
#include "files/recording_entries.hpp"
#include "files/recording_format.hpp"
#include "formats/recordings/recorded_frame_reader.hpp"
#include "formats/recordings/recorded_particles.hpp"
#include "formats/recordings/recorded_session.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {

RecordingStream::RecordingStream(PipedMessages& messages, const ReadLimits& limits)
    : messages_(messages), limits_(limits) {
    if (!messages_.begins_with(files::recording_magic))
        messages_.fail(
            "neither a recording nor bricks: its first line is neither 'Meniscus recording' nor 'Meniscus "
            "bricks' (byte " +
            std::to_string(messages_.position()) + " is another, or its end)");
    const auto bytes = messages_.next(files::max_recording_entry_bytes);
    if (!bytes) messages_.fail("it ends at byte " + std::to_string(messages_.position()) + ", before its first entry");
    try {
        const files::RecordingBeginning beginning = files::read_beginning(*bytes);
        has_checksums_ = beginning.has_checksums;
        if (beginning.begin.has_settings()) settings_ = recorded_settings(beginning.begin);
        description_ = recorded_description(beginning.begin);
    } catch (const InvalidInput& e) {
        messages_.fail(e.what());
    }
}

std::optional<RecordingStream::Frame> RecordingStream::next(RecordedParticles& particles) {
    while (true) {
        entry_at_ = messages_.position();
        if (messages_.follows(files::brick_file_magic))
            fail("bricks behind a recording: a pipe has particles or finished bricks, and not both");
        const auto bytes = messages_.next(files::max_recording_entry_bytes);
        if (!bytes) return std::nullopt;
        v1::RecordingEntry entry;
        try {
            entry = files::read_entry(*bytes, has_checksums_);
        } catch (const InvalidInput& e) {
            fail(e.what());
        }
        if (!entry.has_particles()) {
            messages_.begin_frame(entry.bytes(), "what follows the entry at byte " + std::to_string(entry_at_), false);
            messages_.skip_frame();
            messages_.end_frame();
            continue;
        }
        const Frame frame = announced(entry.particles());
        if (entry.particles().finished_bricks()) fail(came_as_bricks(frame.index));
        if (entry.bytes() > limits_.most_bytes)
            fail("frame " + std::to_string(frame.index) + " is announced with " + std::to_string(entry.bytes()) +
                 " bytes; at most " + std::to_string(limits_.most_bytes) +
                 " are read: send smaller frames, or allow more by --max-file-bytes");
        messages_.begin_frame(entry.bytes(), "frame " + std::to_string(frame.index), entry.has_messages_checksum());
        RecordedFrameReader(messages_, {frame.index, entry.particles().particle_count(), entry.bytes()})
            .read(particles);
        const auto checksum = messages_.end_frame();
        if (checksum && *checksum != entry.messages_checksum())
            fail("frame " + std::to_string(frame.index) + " does not have its checksum: it was damaged on its way");
        last_frame_ = frame.index;
        return frame;
    }
}

RecordingStream::Frame RecordingStream::announced(const v1::RecordedParticles& entry) const {
    const std::string name = "frame " + std::to_string(entry.frame_index());
    if (last_frame_ && entry.frame_index() <= *last_frame_)
        fail(name + " after frame " + std::to_string(*last_frame_) + "; indices must rise");
    if (!std::isfinite(entry.simulation_time()))
        fail(name + " has simulation time " + std::to_string(entry.simulation_time()) + "; it must be finite");
    return {entry.frame_index(), entry.simulation_time()};
}

void RecordingStream::fail(const std::string& what) const {
    const std::string behind = last_frame_ ? ", behind frame " + std::to_string(*last_frame_) : "";
    messages_.fail("at byte " + std::to_string(entry_at_) + behind + ": " + what);
}

}  // namespace meniscus::formats
