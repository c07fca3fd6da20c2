// How a session gets its surfaces.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

#include "meniscus/backend_options.hpp"
#include "meniscus/frame_upload.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/mesh_download.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/statistics.hpp"
#include "meniscus/stop_flag.hpp"

namespace meniscus::server {

struct Reconstructed {
    /// Without a download, the mesh is complete.
    Reconstructed(Statistics s, MeshDownload d = {}) : statistics(std::move(s)), download(std::move(d)) {}

    Statistics statistics;
    MeshDownload download;
};

/// Called by one thread of the session.
struct ReconstructFunctions {
    /// Replaces the mesh by the frame's surface with its lattice, which is there once it has been downloaded; throws
    /// what Reconstructor::reconstruct_for_download throws.
    std::function<Reconstructed(const ParticleFrame& frame, Mesh& mesh)> reconstruct;
    /// Replaces the mesh by the last frame's surface with its levels capped; throws what Reconstructor::emit_capped
    /// throws. None if no watcher will ask for a level cap.
    std::function<void(int max_level, Mesh& mesh)> emit_capped{};
    /// Once it is raised, both throw Stopped soon. None: nothing stops them.
    std::shared_ptr<StopFlag> stop{};
    /// Begins to copy a frame's particles to where they are reconstructed, see Reconstructor::send_ahead(). For any
    /// thread, also while the others are called and when nobody calls them any more. None: there is nowhere to copy
    /// them.
    std::function<FrameUpload(const ParticleFrame& frame)> send_ahead{};
    /// Gives the buffers back until the next frame. May be none.
    std::function<void()> release_memory{};
    /// Limits the memory of the next calls, see Reconstructor::limit_memory(). None: it has no limit.
    std::function<void(std::size_t bytes)> limit_memory{};
};

/// The functions of a Reconstructor of these settings: where the server meets core.
ReconstructFunctions make_reconstruct(const Settings& settings, const BackendOptions& backend);

}  // namespace meniscus::server
