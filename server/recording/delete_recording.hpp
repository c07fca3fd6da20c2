// The deletion of a recording, with its line in the log.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "recording/recording_name.hpp"

namespace meniscus::server {

/// Deletes the file, and the folder of its session if that has no other. No later recording of the session is given its
/// number. Readers that have it open can read it to its end. frames: those with a mesh; bytes: of the file; reason: the
/// end of the line. Throws std::system_error that names the path.
void delete_recording(const std::filesystem::path& path, const RecordingName& name, std::uint64_t frames,
                      std::uint64_t bytes, std::string_view reason);

/// A reason.
std::string fewer_frames_than(std::uint64_t min_frames);

}  // namespace meniscus::server
