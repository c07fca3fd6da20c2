// Recordings of sessions, as meniscusd --record keeps them; files/recording_format.hpp describes the files.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "files/random_access_file.hpp"
#include "files/recording_scan.hpp"
#include "formats/containers/named_values.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::formats {

using files::RecordedRange;

/// A frame as the recording announces it. Times are those of the server's wall clock.
struct RecordedFrame {
    std::uint64_t index = 0;
    double simulation_time = 0.0;
    std::uint64_t particle_count = 0;
    bool finished_bricks = false;  ///< in place of particles
    std::chrono::system_clock::time_point arrived_at;
    RecordedRange particles;
    std::optional<RecordedRange> mesh;
};

/// A frame's particles, owned, encoded as they were uploaded.
struct RecordedParticles {
    std::vector<float> positions;  ///< as ParticleFrame has them, here and below
    std::vector<std::uint16_t> quantized;
    Box quantization_box;
    std::vector<std::uint8_t> levels;
    std::vector<NamedValues> arrays;  ///< those of which the session made attributes

    /// Without arrays.
    ParticleFrame view() const {
        return {.positions = positions, .quantized = quantized, .quantization_box = quantization_box, .levels = levels};
    }
    /// World positions, float32 or decoded.
    std::vector<float> world_positions() const;
};

class Recording {
public:
    /// Finds the frames without reading them. A frame that the file does not hold to its end, and all after it, is left
    /// out: see cut_bytes(). Throws InvalidInput, in one line that names the file, for anything else that is not a
    /// recording.
    explicit Recording(const std::filesystem::path& path);

    const std::filesystem::path& path() const noexcept { return file_.path(); }
    const std::string& session_id() const noexcept { return session_id_; }
    const Settings& settings() const noexcept { return settings_; }
    /// The session's name, axis and unit; empty where the file has a name or a unit that no session has.
    const client::SessionDescription& description() const noexcept { return description_; }
    std::chrono::system_clock::time_point started_at() const noexcept { return started_at_; }
    /// The frames by rising index.
    const std::vector<RecordedFrame>& frames() const noexcept { return frames_; }
    /// The frames with an index from `first` to `last`. Throws InvalidInput if there is none.
    std::vector<RecordedFrame> frames(std::uint64_t first, std::uint64_t last) const;
    std::uint64_t bytes() const noexcept { return file_.size(); }
    /// Bytes at the end that hold no whole frame: the server was killed, the disk was full, or it is being written.
    std::uint64_t cut_bytes() const noexcept { return cut_bytes_; }

    /// Whether damage to its frames shows: recordings of older servers have no checksums.
    bool has_checksums() const noexcept { return has_checksums_; }
    /// Reads a frame's particles and mesh, and nothing into memory: whether they have their checksums.
    bool is_whole(const RecordedFrame& frame) const;
    /// Reads one of this recording's frames. Throws InvalidInput if its messages do not have their checksum, are not a
    /// frame, or another one.
    RecordedParticles particles(const RecordedFrame& frame) const;
    /// Reads the mesh of a frame that has one, and throws as particles() does.
    client::ReceivedFrame mesh(const RecordedFrame& frame) const;

private:
    class Scan;

    files::RandomAccessFile file_;
    std::string session_id_;
    Settings settings_;
    client::SessionDescription description_;
    std::chrono::system_clock::time_point started_at_;
    std::vector<RecordedFrame> frames_;
    std::uint64_t cut_bytes_ = 0;
    bool has_checksums_ = false;
};

}  // namespace meniscus::formats
