// The meshes of a recording's or a publication's frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "cli/sequence/share.hpp"
#include "meniscus/client/received_frame.hpp"

namespace CLI {
class App;
}

namespace meniscus::cli {

/// Whether this is a recording or a publication, or a folder that may hold one.
bool has_frames(const std::filesystem::path& path);

/// Which frames are meant, by their indices; both ends are.
struct FrameRange {
    std::uint64_t first = 0;
    std::uint64_t last = ~std::uint64_t{0};
    std::optional<Share> share{};  ///< of them; none: all
};

/// name: of the frame, for messages.
using TakeFrame = std::function<void(const std::string& name, const client::ReceivedFrame& frame)>;

/// Gives each frame of the range that has a mesh, in order. Throws InvalidInput if there is none,
/// but for a share that has none.
void for_each_frame(const std::filesystem::path& path, const FrameRange& range, const TakeFrame& take);

/// The newest frame, or that of an index, of which the last counts. Throws InvalidInput if there is none.
client::ReceivedFrame frame_of(const std::filesystem::path& path, std::optional<std::uint64_t> index);

/// The flag --frame.
void add_frame_option(CLI::App& command, std::optional<std::uint64_t>& index, const std::string& otherwise);

}  // namespace meniscus::cli
