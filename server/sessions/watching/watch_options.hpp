// The form in which a watcher asks for frames, validated.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "meniscus/settings.hpp"
#include "sessions/sending/encoded_frame.hpp"

namespace meniscus::server {

/// The form that is encoded for a watcher: a format of meshes, or a number of particles.
using WatchForm = std::variant<MeshFormat, std::uint64_t>;

struct WatchOptions {
    MeshFormat format;
    std::optional<Box> region{};         ///< world units: only bricks that touch it
    std::uint64_t bytes_per_second = 0;  ///< in the mean; 0: no limit
    bool spray = false;                  ///< whether it comes beside the meshes, all of it
    bool once = false;                   ///< a snapshot: the newest mesh, and nothing after it; no watcher
    /// Set: the frames' particles in place of their meshes; of a frame with more than this number, every k-th; 0: all.
    std::optional<std::uint64_t> max_particles{};
    std::optional<std::array<double, 3>>
        viewpoint{};  ///< world units: nearest bricks first; else those with the most triangles

    WatchForm form() const { return max_particles ? WatchForm(*max_particles) : WatchForm(format); }
    bool wants_meshes() const { return !max_particles; }
    bool wants(const MeshFormat& mesh) const { return wants_meshes() && format == mesh; }
};

}  // namespace meniscus::server
