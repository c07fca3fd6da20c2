// Where recordings are, and which frames of one are meant.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "formats/recordings/recording.hpp"

namespace CLI {
class App;
}

namespace meniscus::cli {

/// The recordings in a folder and in the folders of its sessions, by name. Throws InvalidInput if there is no such
/// folder.
std::vector<std::filesystem::path> recordings_in(const std::filesystem::path& folder);

/// Whether this is a recording, or a folder of some.
bool is_recording(const std::filesystem::path& path);

/// The argument RECORDING and the flags --from and --to.
struct RecordingSelection {
    std::string path;  ///< a recording, or a folder that holds one
    std::uint64_t from = 0;
    std::uint64_t to = std::numeric_limits<std::uint64_t>::max();

    void add_to(CLI::App& command);
    /// The flags alone.
    void add_range_to(CLI::App& command);
    bool is_range_given() const { return from != 0 || to != std::numeric_limits<std::uint64_t>::max(); }
    /// Says on stderr if its end is missing. Throws InvalidInput if it is not one recording.
    formats::Recording open() const;
};

}  // namespace meniscus::cli
