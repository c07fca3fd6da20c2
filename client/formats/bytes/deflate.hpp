// Compression and checksums by zlib.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace meniscus::formats {

/// The bytes as a stream with zlib's header, the fastest rather than the smallest. Throws NotBuilt in a build without
/// zlib, here and below.
std::string deflated(std::string_view bytes);

/// The CRC-32 of zip files of what comes behind bytes with the CRC-32 `before`; of no bytes it is 0.
std::uint32_t crc32(std::uint32_t before, std::string_view bytes);

}  // namespace meniscus::formats
