// A frame's run on the GPU: upload, kernels, counts; again with more room until everything fits; as a graph once it
// does.
//
// All arrays lie in device memory for capacities that grow when a frame needs more; then the frame runs once more.
// Counts stay on the device: kernels loop over as many elements as they find there, from launches sized by capacities.
// Sweeps that end when nothing changes end on the device (steps/adjust_levels/sweeps.hpp). So the host waits once a
// frame, for the counts. Once a frame has passed without growth, its chain of kernels is captured as a graph, which
// later frames replay until something grows. A first frame runs several times: each run ends where an array is too
// small, and what comes after it is only known to the next.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/cuda/array_memory.hpp"
#include "engine/cuda/event_clock.hpp"
#include "engine/cuda/graph.hpp"
#include "engine/cuda/launch.hpp"
#include "engine/cuda/mapped_stop.hpp"
#include "engine/cuda/pinned_memory.hpp"
#include "engine/cuda/state.hpp"
#include "engine/cuda/upload.hpp"
#include "engine/cuda/upload_areas.hpp"
#include "meniscus/backend_options.hpp"
#include "meniscus/part.hpp"
#include "meniscus/particle_frame.hpp"
#include "particles/placed_frame.hpp"
#include "pipeline/cuda_mesh_sets.hpp"
#include "pipeline/cuda_particle_check.hpp"
#include "pipeline/cuda_pipeline.hpp"

namespace meniscus::cuda {

class FrameRun {
public:
    FrameRun(const LatticeSettings& settings, const BackendOptions& options, MeshSets& sets, UploadAreas& areas,
             const std::shared_ptr<MemoryAccount>& account, const std::shared_ptr<MemoryAccount>& device_account);

    /// Reconstructs a valid frame, up to its mesh on the device. Throws LimitExceeded for one that crowds or is too
    /// much work, and Stopped, after which the next frame may follow; and LimitExceeded for one that needs more than
    /// can be numbered or held, after which nothing may.
    void run(const PlacedFrame& particles);
    /// See BackendReconstruction::validate_on_device().
    ParticlesByLevel validate(const ParticleFrame& on_device, cudaStream_t made_on, const Settings& settings);
    /// See BackendReconstruction::numbers_on_device(), after validate().
    AttributeNumbers find_numbers(const ParticleFrame& on_device);
    /// The mesh of the last frame once more, with no cell finer than max_level. first: whether the levels on the device
    /// are still those that the frame found.
    void emit_capped(int max_level, bool first);

    /// The places of the last frame's spray, where the settings want it listed; waits for the copy.
    void copy_spray(Array<Point>& spray);

    /// The seams of the last frame, which was a part of one; waits for them.
    std::vector<Seam> seams();

    /// The greatest sample of the last frame, see BackendReconstruction; waits for it.
    float greatest_sample();

    const State& state() const { return state_; }
    /// Counts of the last run.
    const Counts& counts() const { return *reinterpret_cast<const Counts*>(host_counts_.get()); }
    /// The number of elements that the last run needed.
    std::uint64_t needed(Resource r) const { return counts().needed[static_cast<int>(r)]; }
    const EventClock& clock() const { return clock_; }
    Stream& stream() { return stream_; }

private:
    /// One set of mesh arrays has one graph, since graphs hold addresses.
    struct CapturedRun {
        Graph graph;
        std::uint64_t mesh_version = 0;  ///< version of the mesh arrays that it was captured for
    };

    /// grown: whether arrays have moved since the frame before.
    void run_until_it_fits(const PlacedFrame& particles, const FrameArrays& arrays, UploadAreas::Place place,
                           bool grown);
    /// Waits for the turn on the device, runs the frame, and waits for it.
    void run_once(const PlacedFrame& particles, const FrameArrays& arrays, UploadAreas::Place& place, bool grown);
    /// Puts a frame's kernels on the stream, behind the upload. captured: into a graph.
    void enqueue(bool captured);
    /// Where CUDA makes no graph, frames run without one from here on.
    void capture(Graph& graph);
    void fetch_counts();
    /// The graph for the current set of mesh arrays; dropped if those have moved.
    CapturedRun& current_graph();
    void drop_graphs();
    using Needed = decltype(Counts::needed);
    /// Makes room in all arrays; in the mesh's by changing their numbers alone, see MeshSets::fit(). Returns whether
    /// there was too little room.
    bool make_room(const Needed& needed, std::uint64_t payload_bytes, const AttributeShape& attributes);
    /// Makes room after a run that has found too little. Where only the mesh lacked room, all other arrays stay.
    void make_more_room();
    void require_indexable_counts() const;
    /// Fault finding before a run and after it, see ArrayMemory.
    void poison();
    void require_whole_guards();
    /// Throws the refusal for which the last run has stopped, unless it lacked room.
    void require_no_refusal() const;

    int device_;
    MappedStop stop_;
    std::function<void(const std::string&)> notice_;  ///< see BackendOptions; may be none
    MeshSets& sets_;
    UploadAreas& areas_;
    // A frame that failed may have left copies under way: pinned memory outlives the stream, whose end waits for them.
    Upload upload_;
    PinnedMemory host_counts_;
    Stream stream_;
    std::optional<ParticleCheck> particle_check_;  ///< exists from the first frame on that comes from the device
    std::shared_ptr<MemoryAccount> account_, device_account_;
    ArrayMemory memory_;
    State state_;
    Launcher launcher_;
    EventClock clock_;
    bool uses_graphs_ = uses_graphs();
    std::array<CapturedRun, 2> graphs_;  ///< a graph for each set of mesh arrays
    std::uint64_t particles_ = 0;        ///< number of particles of the last frame
    bool settled_ = false;               ///< whether the last frame needed no more room
    bool has_borders_ = false;           ///< whether the arrays of a part's borders have room
    FrameParts parts_;                   ///< parts of the last frame
};

}  // namespace meniscus::cuda
