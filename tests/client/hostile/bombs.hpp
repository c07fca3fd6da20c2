// Files of kilobytes to megabytes that are made to take all memory, or days.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace meniscus::test {

struct Bomb {
    std::string name;       ///< of its idea
    std::string extension;  ///< of its format, with the dot
    bool mesh = false;      ///< it is one for those that read meshes
    std::function<std::string()> bytes;
};

/// With limits for a reader that may take 64 MiB: to be refused or read within them.
std::vector<Bomb> bombs();
/// Writes it to a file, in a process of its own: a process that is started counts the memory of the one that starts it
/// as its peak.
void write(const Bomb& bomb, const std::filesystem::path& path);
inline constexpr double most_bomb_seconds = 2.0;  ///< of processor time
inline constexpr double most_bomb_megabytes = 256.0;

}  // namespace meniscus::test
