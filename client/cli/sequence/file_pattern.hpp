// File names of a sequence: "frame_{}.vtk".
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace meniscus::cli {

/// A path in which `{}` stands for a frame number, or `{:0W}` for one padded with zeros to W digits.
class FilePattern {
public:
    explicit FilePattern(const std::string& text);

    bool has_number() const { return has_number_; }
    /// The pattern as it was given.
    const std::string& text() const { return text_; }
    /// The path of that frame; the same for all frames if has_number() is false.
    std::filesystem::path at(std::uint64_t number) const;

    /// The files that are there, by number. From then on `{}` is padded with zeros as the first of them is; `{:0W}`
    /// stays. Throws InvalidInput if two files have the same number.
    std::map<std::uint64_t, std::filesystem::path> match_existing();
    /// Writes `{}` as the other pattern does.
    void pad_like(const FilePattern& other);

    /// Throws InvalidInput for a name that is no file and looks like a sequence in another notation, frame_*.vtk or
    /// frame_%04d.vtk, with how it is written here.
    void require_no_other_notation() const;

private:
    std::string text_;
    std::string before_;
    std::string after_;
    bool has_number_ = false;
    bool fixed_width_ = false;
    std::size_t width_ = 0;
};

}  // namespace meniscus::cli
