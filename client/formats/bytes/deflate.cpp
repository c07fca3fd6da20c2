#include "formats/bytes/deflate.hpp"

#include <zlib.h>

#include <stdexcept>

namespace meniscus::formats {

std::string deflated(std::string_view bytes) {
    uLongf size = ::compressBound(static_cast<uLong>(bytes.size()));
    std::string out(size, '\0');
    if (::compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                    static_cast<uLong>(bytes.size()), Z_BEST_SPEED) != Z_OK)
        throw std::runtime_error("zlib does not compress " + std::to_string(bytes.size()) + " bytes");
    out.resize(size);
    return out;
}

std::uint32_t crc32(std::uint32_t before, std::string_view bytes) {
    if (bytes.empty()) return before;  // zlib takes no address for a new beginning
    return static_cast<std::uint32_t>(::crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace meniscus::formats
