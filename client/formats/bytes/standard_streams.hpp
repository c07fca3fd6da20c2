// "-" in place of a file: standard input where it is read, standard output where it is written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace meniscus::formats {

inline bool is_standard_stream(const std::filesystem::path& path) {
    return path == "-";
}

/// The name of an input in messages.
inline std::string input_name(const std::filesystem::path& path) {
    return is_standard_stream(path) ? "standard input" : path.string();
}
inline std::string output_name(const std::filesystem::path& path) {
    return is_standard_stream(path) ? "standard output" : path.string();
}

/// The bytes of the file, or of standard input to its end. Throws InvalidInput if they cannot be read, or are more than
/// `most_bytes`.
std::string read_input(const std::filesystem::path& path,
                       std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());

}  // namespace meniscus::formats
