// How a session gets its surfaces.
#pragma once

#include <functional>

#include "meniscus/mesh.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus::server {

/// Called by one thread of the session.
struct ReconstructFunctions {
    /// Replaces the mesh by the frame's surface; throws what Reconstructor::reconstruct throws.
    std::function<Statistics(const ParticleFrame& frame, Mesh& mesh)> reconstruct;
    /// Replaces the mesh by the last frame's surface with its levels capped; throws what Reconstructor::emit_capped throws.
    /// None if no watcher will wish for a level cap.
    std::function<void(int max_level, Mesh& mesh)> emit_capped{};
};

}  // namespace meniscus::server
