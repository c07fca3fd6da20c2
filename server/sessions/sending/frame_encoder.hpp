// A mesh to the messages that carry it.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/mesh_download.hpp"
#include "meniscus/statistics.hpp"
#include "sessions/handover/worker_pool.hpp"
#include "sessions/sending/encoded_frame.hpp"
#include "sessions/sending/finished_bricks.hpp"
#include "sessions/sending/scratch_pool.hpp"

namespace meniscus::server {

/// A frame after its reconstruction, or one that came as finished bricks.
struct ReconstructedFrame {
    /// The surface with its levels capped; `made` if a watcher asked for it.
    struct CappedMesh {
        bool made = false;
        Mesh mesh;
    };

    ReconstructedFrame() = default;
    ReconstructedFrame(ReconstructedFrame&&) = delete;  // the download refers to the mesh

    std::uint64_t number = 0;  ///< frames of the session up to this one
    std::uint64_t index = 0;
    std::uint64_t run_id = 0;
    double simulation_time = 0.0;
    std::chrono::steady_clock::time_point received_at;
    Mesh mesh;  ///< of finished bricks its lattice, the names and forms of its attributes, and its spray
    std::shared_ptr<const FinishedBricks> finished;  ///< none: the mesh has all of it
    MeshDownload download;                           ///< of that mesh
    std::array<CappedMesh, 2> capped;                ///< at levels 1 and 2
    Statistics statistics;
    mutable std::array<std::optional<std::vector<AttributeRange>>, 3> ranges;  ///< see ranges_at()

    /// Gives up the meshes.
    void release_memory() {
        download = {};
        mesh = {};
        finished = {};
        capped = {};
        ranges = {};
    }
    CappedMesh& capped_at(int max_level) { return capped.at(static_cast<std::size_t>(max_level - 1)); }
    /// Null if it was not made.
    const Mesh* mesh_at(int max_level) const {
        if (max_level == 3) return &mesh;
        const CappedMesh& cap = capped.at(static_cast<std::size_t>(max_level - 1));
        return cap.made ? &cap.mesh : nullptr;
    }
    /// The download of the mesh at this cap; meshes with their levels capped are complete.
    const MeshDownload& download_at(int max_level) const {
        static const MeshDownload complete;
        return max_level == 3 ? download : complete;
    }
    /// The ranges of the attributes of the mesh at this cap, which was made: found for its first format, kept for the
    /// others. For one thread at a time.
    const std::vector<AttributeRange>& ranges_at(int max_level) const {
        auto& found = ranges.at(static_cast<std::size_t>(max_level - 1));
        if (!found) found = download_at(max_level).attribute_ranges(*mesh_at(max_level));
        return *found;
    }
};

/// Called with every message but the end as soon as it is there, one call at a time. The parts of a brick follow one
/// another.
using MessageSink = std::function<void(const SharedMessage&)>;

/// Brings the mesh down, or its bricks where a GPU can pack them, and encodes these in parallel, but those whose
/// content `before` has already: an earlier frame of the session in the same format, or none. Finished bricks are
/// passed on, or recoded. The frame has the mesh of that format. sink may be empty. Throws DeviceError if the mesh
/// cannot come down, LimitExceeded if the account of the scratch memory would pass its limit. spray_to_sink: whether
/// the sink gets the spray as well, which the encoded frame has anyway.
std::shared_ptr<const EncodedFrame> encode_frame(const ReconstructedFrame& frame, const MeshFormat& format,
                                                 const EncodedFrame* before, WorkerPool& workers, ScratchPool& scratch,
                                                 const MessageSink& sink, bool spray_to_sink = false);

/// The statistics of a frame whose simulator wants no meshes, until now.
FrameStatistics statistics_of(const ReconstructedFrame& frame);
/// The message that carries them.
SharedMessage serialize(const FrameStatistics& statistics);

}  // namespace meniscus::server
