// From the mesh that a watcher has to a newer one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "sessions/sending/encoded_frame.hpp"
#include "sessions/watching/watch_options.hpp"

namespace meniscus::server {

/// Which bricks a watcher has, of the last frame that it has been sent whole. Refers to no encode, so that it keeps
/// none alive.
struct WatcherMesh {
    struct Brick {
        std::array<std::int32_t, 3> place{};
        ContentHash content_hash{};
    };
    std::uint64_t frame_index = 0;
    std::vector<Brick> bricks;  ///< ordered by place (z, y, x)
};

struct FrameUpdate {
    std::deque<SharedMessage> messages;  ///< in the order of sending
    std::size_t bytes = 0;               ///< of them
    WatcherMesh result{};                ///< what the watcher has after the last one, of a mesh
};

/// The most vanished bricks that an update names, so that its announcement stays below 2 MB; beyond that the mesh is
/// sent whole.
inline constexpr std::size_t max_vanished = 65536;

/// base: what the watcher has; none: the mesh is sent whole.
FrameUpdate update_mesh(const EncodedFrame& frame, const WatchOptions& options, const WatcherMesh* base);

}  // namespace meniscus::server
