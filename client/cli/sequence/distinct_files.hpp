// A check that no command writes over a file that it reads.
#pragma once

#include <sys/types.h>

#include <compare>
#include <filesystem>
#include <map>
#include <optional>

namespace meniscus::cli {

/// The files that a command is about to read and to write. To be asked before any work.
class DistinctFiles {
public:
    /// "-": standard input.
    void add_input(const std::filesystem::path& path);
    /// "-": standard output. Throws InvalidInput if this is a file that is read, by whatever name or link, or one that
    /// is written already.
    void add_output(const std::filesystem::path& path);

private:
    /// The identity of a file, whatever its names.
    struct Identity {
        dev_t device;
        ino_t number;
        auto operator<=>(const Identity&) const =
            default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 means what the compiler writes here
    };
    static std::optional<Identity> identity(const std::filesystem::path& path, int standard_stream);

    std::map<Identity, std::filesystem::path> inputs_;
    std::map<Identity, std::filesystem::path> outputs_;
    std::map<std::filesystem::path, std::filesystem::path> output_names_;  ///< without links and dots, as it was given
};

}  // namespace meniscus::cli
