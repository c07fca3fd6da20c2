// Output files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace meniscus::formats {

/// Writes to a temporary file beside `path`, or beside the file that it is a link to. commit() renames it to that;
/// without commit() nothing remains. What cannot be replaced is written as it is: "-", which is standard output, a
/// pipe, a device.
class AtomicFile {
public:
    /// Throws InvalidInput, naming the path and the reason, if it cannot be created there.
    explicit AtomicFile(std::filesystem::path path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Throws std::runtime_error, naming the path and the reason, if the write fails, on a full disk for example.
    void write(std::string_view bytes);
    /// Throws as write() does, since bytes are gathered before they are written; InvalidInput if the file cannot be
    /// renamed.
    void commit();

private:
    void flush();
    void write_now(std::string_view bytes);
    [[noreturn]] void fail(int error) const;

    std::filesystem::path path_;       ///< as it was given
    std::filesystem::path place_;      ///< without links
    std::filesystem::path temporary_;  ///< empty: there is none, or it has been renamed
    int descriptor_ = -1;
    std::string gathered_;
};

/// Opens, writes and commits.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Creates the directory and its parents where they are missing. Throws InvalidInput if that fails.
void make_directory(const std::filesystem::path& path);

}  // namespace meniscus::formats
