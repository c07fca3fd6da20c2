// Decompression of untrusted bytes, piece by piece, up to a size that is known before.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "formats/bytes/byte_cursor.hpp"

namespace meniscus::formats {

enum class Deflate {
    raw,   ///< as in zip files
    zlib,  ///< with zlib's header
    gzip,
};

/// Most bytes that a compressed byte can give (zlib.net, "zlib technical details": 1032, as a match of 258 takes two
/// bits).
inline constexpr std::uint64_t most_deflation = 1032;

/// Decompresses bytes from their beginning on, as far as is asked for.
class Inflater {
public:
    /// at, what: for messages. compressed: borrowed. Throws by `at` in a build without zlib.
    Inflater(const ByteCursor& at, std::string_view compressed, Deflate form, std::string_view what);
    ~Inflater();
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    /// Appends to `out` what comes next until it has `size` bytes, or all there are. Memory grows with what is found,
    /// not with what is asked for. Throws by `at` for bytes that are damaged or cut.
    void extend(std::string& out, std::uint64_t size);

private:
    struct Stream;

    ByteCursor at_;
    std::string_view compressed_;  ///< not yet read
    std::string what_;
    std::unique_ptr<Stream> stream_;
    bool at_end_ = false;
};

/// All of it. most: bytes of the result. Throws by `at`, naming `what`, for bytes that are damaged or cut, and for more
/// than `most` bytes.
std::string inflate(const ByteCursor& at, std::string_view compressed, Deflate form, std::uint64_t most,
                    std::string_view what);

}  // namespace meniscus::formats
