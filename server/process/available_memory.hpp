// How much memory this process may use.
#pragma once

#include <cstdint>
#include <filesystem>

namespace meniscus::server {

/// Bytes: the machine's memory, or what the control groups (version 2 or 1) of this process leave of it, as in a
/// container. 0 if neither is known. root: of the file systems /proc and /sys, for tests.
std::uint64_t available_memory(const std::filesystem::path& root = "/");

}  // namespace meniscus::server
