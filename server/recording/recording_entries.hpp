// Frames to the bytes that recordings hold; files/recording_format.hpp describes them.
#pragma once

#include <cstdint>
#include <string>

#include "meniscus/settings.hpp"
#include "sessions/intake/input_frame.hpp"
#include "sessions/sending/encoded_frame.hpp"

namespace meniscus::server {

/// An entry and the messages that follow it, apart: the latter are large.
struct RecordingBytes {
    std::string entry;
    std::string messages;

    std::uint64_t size() const { return entry.size() + messages.size(); }
};

/// The beginning of a file. Times are microseconds since 1970-01-01 UTC. owner: the creator of the session; may be
/// empty.
std::string recording_begin(const std::string& session_id, const Settings& settings, std::int64_t started_at,
                            const std::string& owner = {}, const v1::SessionDescription& description = {});
RecordingBytes recorded_particles(const InputFrame& frame, std::int64_t arrived_at);
RecordingBytes recorded_mesh(const EncodedFrame& frame);

}  // namespace meniscus::server
