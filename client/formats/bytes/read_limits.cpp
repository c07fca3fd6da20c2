#include "formats/bytes/read_limits.hpp"

#include <unistd.h>

#include <algorithm>

namespace meniscus::formats {

std::uint64_t usual_most_bytes() {
    constexpr std::uint64_t most = std::uint64_t{8} << 30;
    const long pages = ::sysconf(_SC_PHYS_PAGES);
    const long page_bytes = ::sysconf(_SC_PAGESIZE);
    if (pages <= 0 || page_bytes <= 0) return most;
    return std::min(most, static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page_bytes) / 2);
}

}  // namespace meniscus::formats
