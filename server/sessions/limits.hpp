// What the server refuses to exceed. 0 means no limit.
#pragma once

#include <cstddef>
#include <cstdint>

namespace meniscus::server {

/// Of one chunk of particle data, and of one part of a brick.
inline constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

struct Limits {
    std::uint32_t sessions = 16;
    std::uint32_t watchers_per_session = 64;
    std::uint64_t particles_per_frame = 0;
    /// For the reconstruction of one session, and as much again for its frames on their way in.
    std::size_t bytes_per_session = 0;
    /// For the reconstruction of one session on its GPU.
    std::size_t device_bytes_per_session = 0;
};

}  // namespace meniscus::server
