// Bounds-checked reading of a file that is in memory: every reader of this folder goes through it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

#include "meniscus/quoted.hpp"  // for messages about arbitrary bytes

namespace meniscus::formats {

/// The file's bytes. most_bytes: more are not read. Throws InvalidInput if it does not exist, is not a regular file, is
/// larger or cannot be read.
std::string read_file(const std::filesystem::path& path,
                      std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());

/// Reads untrusted bytes. Errors name the file.
class ByteCursor {
public:
    /// name: the file, for messages. bytes: borrowed.
    ByteCursor(std::string name, std::string_view bytes) : name_(std::move(name)), bytes_(bytes) {}

    const std::string& name() const { return name_; }
    std::size_t position() const { return position_; }
    std::size_t remaining() const { return bytes_.size() - position_; }
    std::string_view rest() const { return bytes_.substr(position_); }

    /// The bytes before the next line end (LF or CR LF). Throws InvalidInput at the end of the file.
    std::string_view line();
    /// The next word, white space before it skipped. Throws InvalidInput if there is none.
    std::string_view word();
    /// Skips white space; false at the end of the file.
    bool skip_space();
    /// The next `size` bytes. Throws InvalidInput if fewer remain.
    std::string_view take(std::size_t size);

    /// Throws InvalidInput unless `count` elements of at least `bytes_each` bytes can still follow. To be called before
    /// memory is allocated for a count that a file announces. `what` names the elements.
    void expect(std::size_t count, std::size_t bytes_each, std::string_view what) const;

    /// The next word as a number. Throws InvalidInput for anything else; NaN and infinity are numbers.
    double number(std::string_view what);
    /// The next word as a count. Throws InvalidInput for anything else.
    std::size_t count(std::string_view what);

    /// Throws InvalidInput: "NAME: message".
    [[noreturn]] void fail(const std::string& message) const;

private:
    std::string name_;
    std::string_view bytes_;
    std::size_t position_ = 0;
};

/// Throws InvalidInput, naming `what`, unless the whole of `text` is a number.
double to_number(std::string_view text, const ByteCursor& at, std::string_view what);
/// Throws InvalidInput, naming `what`, unless the whole of `text` is a non-negative integer.
std::size_t to_count(std::string_view text, const ByteCursor& at, std::string_view what);

}  // namespace meniscus::formats
