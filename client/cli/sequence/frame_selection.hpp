// Which frames of a sequence are meant.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "cli/sequence/file_pattern.hpp"

namespace CLI {
class App;
}

namespace meniscus::cli {

struct NumberedFile {
    std::uint64_t number = 0;
    std::filesystem::path path;
};

/// The flags --start, --end, --step and --skip-missing.
struct FrameSelection {
    std::optional<std::uint64_t> start;
    std::optional<std::uint64_t> end;
    std::uint64_t step = 1;
    bool skip_missing = false;

    void add_to(CLI::App& command);
    /// --start and --end alone.
    void add_range_to(CLI::App& command);
    bool is_in_range(std::uint64_t number) const { return (!start || number >= *start) && (!end || number <= *end); }
    /// Whether any of the flags is given.
    bool is_given() const { return start || end || step != 1 || skip_missing; }
    /// The files of the pattern, by rising number. `{}` in the pattern then stands for numbers as these files have
    /// them. Throws InvalidInput if there are none, if two have the same number, or if one is missing: the one that is
    /// named as start or end, or any between the two where both are named.
    std::vector<NumberedFile> files(FilePattern& pattern) const;
};

}  // namespace meniscus::cli
