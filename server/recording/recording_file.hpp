// One file of a recording, which only grows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace meniscus::server {

/// NNNNNN.recording, of more digits from a million on.
std::string recording_file_name(std::uint32_t number);

/// Blocks; for one thread. Readable for the operator alone: folders have mode 0700, files 0600.
class RecordingFile {
public:
    /// Creates directory/SESSION/NNNNNN.recording with the next number that is free, and of no recording that was
    /// deleted. session_id: a UUID, as the edge has verified. Throws std::runtime_error that names the path and the
    /// reason.
    RecordingFile(const std::filesystem::path& directory, const std::string& session_id);
    ~RecordingFile();
    RecordingFile(const RecordingFile&) = delete;
    RecordingFile& operator=(const RecordingFile&) = delete;

    const std::filesystem::path& path() const noexcept { return path_; }
    std::uint32_t number() const noexcept { return number_; }
    /// Throws std::runtime_error that names the path and the reason; some of the bytes may then be in the file.
    void append(std::string_view bytes);

private:
    std::filesystem::path path_;
    std::uint32_t number_ = 0;
    int descriptor_ = -1;
};

}  // namespace meniscus::server
