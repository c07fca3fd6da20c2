// File names of a sequence: "frame_{}.vtk".
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace meniscus::cli {

/// A path in which `{}` stands for a frame number, or `{:0W}` for one padded with zeros to W digits.
class FilePattern {
public:
    explicit FilePattern(const std::string& text);

    bool has_number() const { return has_number_; }
    /// The path of that frame; the same for all frames if has_number() is false.
    std::filesystem::path at(std::uint64_t number) const;

    /// Finds how existing files write `{}`: as it is, else padded to 2 to 9 digits, whichever file of this number
    /// exists first. Leaves `{:0W}` alone.
    void match_existing(std::uint64_t number);
    /// Writes `{}` as the other pattern does.
    void pad_like(const FilePattern& other);

private:
    std::string before_;
    std::string after_;
    bool has_number_ = false;
    bool fixed_width_ = false;
    std::size_t width_ = 0;
};

}  // namespace meniscus::cli
