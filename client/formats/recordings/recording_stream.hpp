// The particles of a recording that is read once, from front to back, as it is written: from a pipe, or from a file.
// files/recording_format.hpp describes the bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "formats/bytes/read_limits.hpp"
#include "formats/recordings/piped_messages.hpp"
#include "formats/recordings/recording.hpp"
#include "meniscus/client/session_info.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/v1/recording.pb.h"

namespace meniscus::formats {

class RecordingStream {
public:
    /// Reads the beginning, of which the version alone must be there, and borrows the messages. limits: of a frame's
    /// bytes. Throws InvalidInput, in one line that names the input and the byte, for what is no recording.
    explicit RecordingStream(PipedMessages& messages, const ReadLimits& limits = {});

    /// What the beginning says of the session; no settings: it leaves them to the reader.
    const std::optional<Settings>& settings() const noexcept { return settings_; }
    const client::SessionDescription& description() const noexcept { return description_; }

    struct Frame {
        std::uint64_t index = 0;
        double simulation_time = 0.0;  ///< seconds
    };
    /// Waits for the next frame and fills the particles, whose memory stays; none at the end. Meshes are passed over.
    /// Throws InvalidInput, in one line that names the input, the frame and the byte, for what is no recording, for
    /// bytes that do not have their checksum, and where it ends within a frame.
    std::optional<Frame> next(RecordedParticles& particles);

private:
    Frame announced(const v1::RecordedParticles& entry) const;
    [[noreturn]] void fail(const std::string& what) const;

    PipedMessages& messages_;
    ReadLimits limits_;
    std::uint64_t entry_at_ = 0;
    bool has_checksums_ = false;
    std::optional<Settings> settings_;
    client::SessionDescription description_;
    std::optional<std::uint64_t> last_frame_;  ///< its index
};

}  // namespace meniscus::formats
