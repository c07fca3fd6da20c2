// Output files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

namespace meniscus::formats {

/// Writes to a temporary file beside `path`. commit() renames it to `path`; without commit() nothing remains.
class AtomicFile {
public:
    /// Throws InvalidInput, naming the path and the reason, if it cannot be created there.
    explicit AtomicFile(std::filesystem::path path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes) { out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); }
    std::ostream& stream() { return out_; }
    /// Throws std::runtime_error if the write fails, on a full disk for example.
    void commit();

private:
    std::filesystem::path path_;
    std::filesystem::path temporary_;
    std::ofstream out_;
};

/// Opens, writes and commits.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Creates the directory and its parents where they are missing. Throws InvalidInput if that fails.
void make_directory(const std::filesystem::path& path);

}  // namespace meniscus::formats
