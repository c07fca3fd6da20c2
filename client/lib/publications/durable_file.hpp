// Files that a reader sees whole or not at all, and that outlast a crash once they are seen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace meniscus::client {

/// Writes a file beside, syncs it, renames it, and syncs its folder: of two calls the second file is not there after a
/// crash without the first. Throws std::runtime_error, naming the path and the reason.
void write_durably(const std::filesystem::path& path, std::string_view bytes);

/// The bytes of a regular file. Throws InvalidInput, naming the path, if it has more than `most` or cannot be read.
std::string read_whole(const std::filesystem::path& path, std::uint64_t most);

}  // namespace meniscus::client
