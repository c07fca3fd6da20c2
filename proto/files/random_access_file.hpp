// A file too large to be read whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace meniscus::files {

class RandomAccessFile {
public:
    /// Throws InvalidInput if it does not exist, is not a regular file or cannot be read.
    explicit RandomAccessFile(std::filesystem::path path);
    ~RandomAccessFile();
    RandomAccessFile(RandomAccessFile&& other) noexcept;
    RandomAccessFile& operator=(RandomAccessFile&& other) noexcept;

    const std::filesystem::path& path() const noexcept { return path_; }
    /// Bytes, when it was opened.
    std::uint64_t size() const noexcept { return size_; }
    /// Whether its writer has it open: see writing_mark.hpp.
    bool being_written() const noexcept;
    /// Whether its writer is known to have closed it: false also where the file system keeps no marks.
    bool is_closed() const noexcept;
    /// `size` bytes from `first` on, all of which the file has. Throws InvalidInput if it has been cut since.
    std::string read(std::uint64_t first, std::size_t size) const;

    /// Throws InvalidInput: "PATH: message".
    [[noreturn]] void fail(const std::string& message) const;

private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

}  // namespace meniscus::files
