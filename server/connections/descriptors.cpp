#include "connections/descriptors.hpp"

#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>

namespace meniscus::server {

namespace {

/// The most of the HTTP port.
constexpr std::size_t http_connections = 512;
/// Each is answered in milliseconds; the next one takes the place of one that is silent.
constexpr std::size_t probe_connections = 32;
/// A port with fewer would be of no use; with as few descriptors as that, they may run out.
constexpr std::size_t fewest = 8;
/// "No limit" is not meant literally: the table of connections grows with it.
constexpr std::size_t most_descriptors = std::size_t{1} << 20;

}  // namespace

std::size_t descriptor_limit() {
    rlimit limit{};
    constexpr std::size_t usual = 1024;
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return usual;
    return std::min<std::size_t>(limit.rlim_cur, most_descriptors);
}

ino_t inode_of(int descriptor) {
    struct stat status {};
    return ::fstat(descriptor, &status) == 0 ? status.st_ino : 0;
}

std::size_t raise_descriptor_limit() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < limit.rlim_max) {
        limit.rlim_cur = std::max(limit.rlim_cur, std::min<rlim_t>(limit.rlim_max, most_descriptors));
        ::setrlimit(RLIMIT_NOFILE, &limit);
    }
    return descriptor_limit();
}

ConnectionShares share_descriptors(std::size_t descriptors, std::size_t own, std::size_t wanted) {
    const std::size_t free = descriptors - std::min(descriptors, own + probe_connections);
    const std::size_t http = std::clamp(free / 4, fewest, http_connections);
    const std::size_t left = std::max(fewest, free - std::min(free, http));
    return {.grpc = wanted == 0 ? left : std::min(wanted, left), .http = http, .probes = probe_connections};
}

}  // namespace meniscus::server
