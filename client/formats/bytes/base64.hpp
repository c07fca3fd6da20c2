// Base64 text as bytes, read piece by piece.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "formats/bytes/byte_cursor.hpp"

namespace meniscus::formats {

/// White space is passed over. Padding ends a stream, and another may begin behind it, as VTK writes a header and its
/// data.
class Base64Reader {
public:
    explicit Base64Reader(std::string_view text) : text_(text) {}

    /// The next `size` bytes. Throws by `at`, naming `what`, if fewer are there or a character is none of base64's.
    /// Memory grows with what is found.
    std::string take(std::size_t size, const ByteCursor& at, std::string_view what);
    /// Upper limit of the bytes that can still follow.
    std::size_t most() const { return ready_.size() + text_.size() / 4 * 3 + 3; }

private:
    /// Appends groups of four digits without anything between them, which most are, while 3 bytes of `size` lack.
    void take_plain_groups(std::string& out, std::size_t size);
    /// Decodes the next four characters to ready_.
    void decode(const ByteCursor& at, std::string_view what);

    std::string_view text_;
    std::string ready_;  ///< decoded and not taken, at most 3 bytes
};

}  // namespace meniscus::formats
