// Decompression of untrusted bytes, piece by piece, up to a size that is known before.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "formats/byte_cursor.hpp"

namespace meniscus::formats {

enum class Deflate {
    raw,   ///< as in zip files
    zlib,  ///< with zlib's header
    gzip,
};

/// A compressed byte gives at most so many (zlib.net, "zlib technical details": 1032, as a match of 258 takes two
/// bits).
inline constexpr std::uint64_t most_deflation = 1032;

/// most: bytes of the result. Memory grows with what is found, not with what is announced. Throws by `at`, naming
/// `what`, for bytes that are damaged or cut, and for more than `most` bytes.
std::string inflate(const ByteCursor& at, std::string_view compressed, Deflate form, std::uint64_t most,
                    std::string_view what);

}  // namespace meniscus::formats
