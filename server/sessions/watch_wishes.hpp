// What a watcher wishes to be sent, as validated.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "meniscus/settings.hpp"
#include "sessions/encoded_frame.hpp"

namespace meniscus::server {

struct WatchWishes {
    MeshFormat format;
    std::optional<Box> region{};         ///< world units: only bricks that touch it
    std::uint64_t bytes_per_second = 0;  ///< in the mean; 0: no limit
    std::optional<std::array<double, 3>> viewpoint{};  ///< world units: nearest bricks first; else those with the most triangles
};

}  // namespace meniscus::server
