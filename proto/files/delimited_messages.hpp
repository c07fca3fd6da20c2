// Protobuf messages one after the other in a file, each after its length in bytes as a varint.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "files/random_access_file.hpp"

namespace meniscus::files {

class DelimitedMessages {
public:
    /// Reads the messages between the bytes `first` and `end` of the file, which outlives this object.
    DelimitedMessages(const RandomAccessFile& file, std::uint64_t first, std::uint64_t end)
        : file_(&file), position_(first), end_(end) {}

    std::uint64_t position() const noexcept { return position_; }
    bool at_end() const noexcept { return position_ == end_; }
    void skip(std::uint64_t bytes) { position_ += bytes; }

    /// The next message's bytes; none, without a step ahead, if the end cuts them. Throws InvalidInput for a length
    /// beyond the limit, before memory is allocated by it.
    std::optional<std::string> next(std::size_t limit);

    /// Throws InvalidInput: "PATH: message".
    [[noreturn]] void fail(const std::string& message) const { file_->fail(message); }

private:
    const RandomAccessFile* file_;
    std::uint64_t position_;
    std::uint64_t end_;
};

}  // namespace meniscus::files
