// The part of a file that a request asks for (RFC 9110, 14.2).
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace meniscus::server {

struct ByteRange {
    std::size_t first = 0;
    std::size_t length = 0;  ///< 0: no byte of the file is in the range
};

/// header: the value of Range. size: of the file, at least 1. None: the whole file is to be sent, as for no header, for
/// one that is none, and for several ranges.
std::optional<ByteRange> byte_range(std::string_view header, std::size_t size);

}  // namespace meniscus::server
