// The numbers of recordings that were deleted: no later recording of the session has one of them, so that a link to one
// that has gone never shows another.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace meniscus::server {

/// The greatest number of the session's recordings that were deleted; 0: none was. Thread-safe.
std::uint32_t greatest_deleted(const std::filesystem::path& directory, const std::string& session_id);

/// Before the recording is deleted. Kept outside of the session's folder, which goes with its last recording: 48 bytes
/// for each session in DIR/.deleted. Thread-safe. Throws std::system_error that names the path.
void note_deleted(const std::filesystem::path& directory, const std::string& session_id, std::uint32_t number);

}  // namespace meniscus::server
