// Encoded bricks as a file, `.bricks`; files/brick_file_format.hpp describes it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "meniscus/client/client.hpp"

namespace meniscus::formats {

/// Writes one frame. Atomic. Throws InvalidInput if the path cannot be written.
void write_bricks(const std::filesystem::path& path, const client::ReceivedFrame& frame);

/// Reads the first frame. Throws InvalidInput, in one line that names the file, for anything else.
client::ReceivedFrame read_bricks(const std::string& name, std::string_view bytes);

/// Reads the messages of one frame: a file without its beginning, as recordings hold them. Throws as read_bricks()
/// does.
client::ReceivedFrame read_brick_messages(const std::string& name, std::string_view bytes);

}  // namespace meniscus::formats
