// The way of a frame through the CUDA backend: the paper's steps in their order, on one stream.
//
// All arrays lie in one piece of device memory, laid out for capacities (frame.hpp) that grow when a frame needs more;
// then the frame runs once more. Counts stay on the device: kernels loop over as many elements as they find there, from
// launches sized by capacities. Sweeps that end when nothing changes end on the device (raise_levels.hpp). So the host
// waits once a frame, for the counts. Once a frame has passed without growth, its chain of kernels is captured as a
// graph, which later frames replay until something grows.
//
//   Upload       pinned memory -> upload, FrameInput                        (outside of the graph: its size is the
//   frame's) register     make_keys, sort, mark_starts, scan, store_particles, count_support_cells;
//                list_reached_bricks, sort, mark_first_keys, scan, store_bricks, mark_reached_cells, scan,
//                number_members, find_neighbors, store_blocks; measure_densities, divide_weights or count_particles
//   sample       sample_base
//   split        collect_base_vertices, find_band, measure_bends, choose_levels, collect_level_sets
//   adjust       balance_and_promote                                        (cooperative)
//   sample       list_corner_points, sample_list, settle_band               (cooperative); list_edge_middles, ...
//   count        list_band, count_cells, count_cracks, scan
//   place        count_vertices, scan, size_mesh, describe_bricks, place_listed
//   emit, fill   emit_cells, fill_listed
//   Counts       -> pinned memory; the host waits
//   PendingMesh  the mesh -> pinned memory -> the caller's arrays           (when they ask for it, on a stream of its
//   own)
//
// What overlaps: pieces of the upload with copying into pinned memory, pieces of the download with copying out of it, a
// frame's download with the next one's kernels, and whole frames of different sessions, each on streams of its own. The
// mesh's arrays are there twice once a frame begins while the one before is still to be downloaded; a caller who takes
// each mesh at once, or leaves it on the device, needs one set. A first frame runs some times: each run ends where an
// array is too small, and what comes after it is only known to the next.
#include <array>
#include <memory>
#include <optional>

#include "engine/arrays.hpp"
#include "engine/cuda/device_memory.hpp"
#include "engine/cuda/graph.hpp"
#include "engine/cuda/mesh_storage.hpp"
#include "engine/cuda/pending_mesh.hpp"
#include "engine/cuda/upload.hpp"
#include "engine/numbering.hpp"
#include "field/kernel.hpp"
#include "pipeline/backend.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

class Reconstruction final : public BackendReconstruction {
public:
    Reconstruction(const Settings& user, int device, const std::shared_ptr<MemoryAccount>& account,
                   const std::shared_ptr<MemoryAccount>& device_account)
        : user_(user),
          device_(device),
          upload_(account),
          host_counts_(account),
          storage_(std::make_shared<MeshStorage>(device, account, device_account)),
          memory_(device, stream_.get(), device_account),
          frame_(LatticeSettings(user)) {
        const Bisection* const bisection = std::get_if<Bisection>(&user.edge_points);
        frame_.bisects = bisection != nullptr;
        frame_.bisection_steps = bisection != nullptr ? bisection->steps : 0;
        frame_.has_normals = user.normals;
        for (unsigned k = 0; k < particle_level_count; ++k) {
            const float support = frame_.settings.support[k];
            frame_.cell_units[k] = support_cell_units(static_cast<std::int64_t>(std::ceil(support)));
            frame_.inverse_support[k] = inverse_support(support);
        }
        int processors = 0;
        check(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device), "cudaDeviceGetAttribute");
        launcher_ = {stream_.get(), 8 * static_cast<unsigned>(processors)};
        host_counts_.reserve(sizeof(Counts));
    }

    ~Reconstruction() override {
        try {
            at_end_.emplace(device_);
        } catch (...) {
            return;  // The device is lost: there is nothing to free on it.
        }
        give_sets_back();
    }

    MeshDownload reconstruct(const ParticleFrame& particles, Mesh& mesh, Statistics& statistics) override {
        return download(reconstruct_on_device(particles, statistics), mesh);
    }

    void emit_capped(int max_level, Mesh& mesh) override {
        const CurrentDevice current(device_);
        take_set();
        for (;;) {
            cap_levels(frame_, max_level, !capped_, launcher_);
            capped_ = true;
            emit(frame_, [] {});
            stream_.synchronize();
            if (counts().overflow == 0) break;
            make_more_room();
        }
        download(mesh_on_device(), mesh).finish();
    }

    DeviceMesh reconstruct_on_device(const ParticleFrame& particles, Statistics& statistics) override {
        const CurrentDevice current(device_);
        run(particles);
        tell(statistics);
        capped_ = false;
        return mesh_on_device();
    }

private:
    DeviceMesh mesh_on_device() const {
        DeviceMesh mesh;
        mesh.vertices = frame_.vertices;
        mesh.normals = user_.normals ? frame_.normals : nullptr;
        mesh.triangles = frame_.triangles;
        mesh.vertex_count = static_cast<std::uint32_t>(counts().needed[static_cast<int>(Resource::vertices)]);
        mesh.triangle_count = static_cast<std::uint32_t>(counts().needed[static_cast<int>(Resource::triangles)]);
        for (std::size_t level = 0; level < triangle_level_count; ++level)
            mesh.levels[level] = {counts().first_triangle[level],
                                  static_cast<std::uint32_t>(counts().triangles[level])};
        mesh.cell_size = frame_.settings.cell_size;
        mesh.offset_bits = frame_.settings.offset_bits;
        mesh.device = device_;
        mesh.stream = stream_.get();
        return mesh;
    }

    /// Memory for it is taken here, so that none can be missing later.
    MeshDownload download(const DeviceMesh& on_device, Mesh& mesh) {
        resize_for_overwrite(mesh.vertices, on_device.vertex_count);
        resize_for_overwrite(mesh.normals, user_.normals ? on_device.vertex_count : 0);
        resize_for_overwrite(mesh.triangles, on_device.triangle_count);
        resize_for_overwrite(mesh.bricks, counts().needed[static_cast<int>(Resource::bricks)]);
        mesh.levels = on_device.levels;
        auto pending = std::make_shared<PendingMesh>(storage_, on_device, frame_.mesh_bricks, mesh);
        pending_[set_] = pending;
        return MeshDownload(std::move(pending));
    }

    /// The download that still reads a set of mesh arrays; none if nothing does.
    std::shared_ptr<PendingMesh> reader(std::size_t set) const {
        auto pending = pending_[set].lock();
        return pending && !pending->is_done() ? pending : nullptr;
    }

    /// A mesh's owner may keep its download for long, and the next reconstruction needs the room: only the host's
    /// memory may outlive this one.
    void give_sets_back() noexcept {
        const auto attempt = [](const auto& action) {
            try {
                action();
            } catch (...) {
                // The device failed: whoever asks for a mesh that is not complete is told.
            }
        };
        // After an exception kernels may still write a set.
        attempt([&] { stream_.synchronize(); });
        for (std::size_t set = 0; set < pending_.size(); ++set) {
            if (const auto pending = reader(set)) attempt([&] { pending->finish(); });
            storage_->sets[set].release();
        }
        attempt([&] { storage_->stream.synchronize(); });
    }

    /// Chooses a set that nothing reads for the mesh that comes. What must come down for that comes down here: its
    /// owner may wait for this very frame.
    void take_set() {
        if (const auto last = reader(set_)) {
            if (take_other_set()) return;
            last->finish();
        }
        with_room([&] { fit_set(); });
    }

    /// Returns whether there is room for it. Where there was none, every frame would try in vain until the sizes
    /// change.
    bool take_other_set() {
        if (one_set_has_to_do_) return false;
        set_ = 1 - set_;
        if (const auto earlier = reader(set_)) earlier->finish();
        try {
            fit_set();
            return true;
        } catch (const LimitExceeded&) {
            set_ = 1 - set_;
            one_set_has_to_do_ = true;
            return false;
        }
    }

    void fit_set() {
        DeviceMemory& memory = storage_->sets[set_];
        if (const std::size_t bytes = frame_.lay_out_mesh(nullptr); memory.bytes() != bytes) {
            graphs_[set_].drop();
            memory.assign(bytes);
            storage_->stream.synchronize();
        }
        frame_.lay_out_mesh(memory.get());
    }

    /// allocate: once more without the other set if there is too little memory.
    template <class Allocate>
    void with_room(const Allocate& allocate) {
        try {
            allocate();
        } catch (const LimitExceeded&) {
            const std::size_t other = 1 - set_;
            if (storage_->sets[other].bytes() == 0) throw;
            if (const auto pending = reader(other)) pending->finish();
            storage_->sets[other].release();
            storage_->stream.synchronize();
            allocate();
        }
    }

    /// The ends of the stages, in the order in which they run.
    static constexpr std::array<Stage, 9> order{
        Stage::register_particles, Stage::sample_field,   Stage::split_cells,
        Stage::adjust_levels,      Stage::sample_field,   Stage::count_triangles,
        Stage::place_vertices,     Stage::emit_triangles, Stage::fill_cracks};

    /// Of the last run; complete after a synchronization.
    const Counts& counts() const { return *reinterpret_cast<const Counts*>(host_counts_.get()); }

    void run(const ParticleFrame& particles) {
        const bool has_levels = !particles.levels.empty();
        if (has_levels != has_levels_) drop_graphs();
        has_levels_ = has_levels;
        particles_ = particles.count();
        bool grown = make_room({});
        take_set();
        for (;;) {
            start_.record(stream_.get());
            upload_.start(particles, frame_, stream_.get());
            Graph& graph = graphs_[set_];
            if (!grown && settled_ && !graph.is_captured()) graph.capture(stream_.get(), [&] { enqueue(true); });
            if (graph.is_captured())
                graph.launch(stream_.get());
            else
                enqueue(false);
            stream_.synchronize();
            if (counts().overflow == 0) break;
            require_uncrowded(counts().crowd, particles.count(), frame_.settings);
            make_more_room();
            grown = true;
        }
        settled_ = !grown;
    }

    void drop_graphs() {
        for (Graph& graph : graphs_) graph.drop();
    }

    using Needed = decltype(Counts::needed);

    /// In the mesh's arrays by number only, see fit_set(). Returns whether there was too little.
    bool make_room(const Needed& needed) {
        const Capacities before = frame_.capacity;
        if (!frame_.capacity.grow_to(particles_, needed)) return false;
        one_set_has_to_do_ = false;
        drop_graphs();
        if (frame_.capacity.same_but_for_mesh(before)) return true;
        const Capacities& room = frame_.capacity;
        const std::uint64_t sums =
            std::max({room.particles, room[Resource::reached_bricks], room[Resource::bricks], room[Resource::blocks]}) +
            1;
        frame_.scratch_bytes = scratch_bytes(room.particles, room[Resource::reached_bricks], sums);
        with_room([&] { memory_.assign(frame_.lay_out(nullptr)); });
        frame_.lay_out(memory_.get());
        check(cudaMemcpyAsync(const_cast<CubeCase*>(frame_.cube_table), cube_table.data(), sizeof(CubeTable),
                              cudaMemcpyHostToDevice, stream_.get()),
              "cudaMemcpyAsync");
        check(cudaMemcpyAsync(const_cast<CrackCase*>(frame_.crack_table), crack_table.data(), sizeof(CrackTable),
                              cudaMemcpyHostToDevice, stream_.get()),
              "cudaMemcpyAsync");
        return true;
    }

    /// After a run that has found too little. Where that was room for the mesh alone, all that the mesh is made of
    /// stays.
    void make_more_room() {
        require_room_for_numbers();
        if (!make_room(counts().needed))
            throw DeviceError("reconstruction", "the counts contradict each other", device_);
        with_room([&] { fit_set(); });
    }

    void require_room_for_numbers() const {
        const auto needed = [&](Resource r) { return counts().needed[static_cast<int>(r)]; };
        require_numbers(needed(Resource::reached_bricks), "the particles reach", "bricks, repetitions counted");
        require_numbers(needed(Resource::bricks), "the particles reach", "bricks", too_many(Resource::bricks));
        require_numbers(needed(Resource::blocks), "the frame reaches", "base cells");
        require_numbers(needed(Resource::samples), "the surface needs", "field samples");
        require_numbers(needed(Resource::triangles), "the surface has", "triangles");
        require_numbers(needed(Resource::vertices), "the surface has", "vertices");
    }

    /// The kernels of a frame whose particles are on their way. captured: into a graph.
    void enqueue(bool captured) {
        const cudaStream_t stream = stream_.get();
        std::size_t step = 0;
        const auto end_stage = [&] { ends_[step++].record(stream, captured); };
        Frame frame = frame_;
        check(cudaMemsetAsync(frame.counts, 0, sizeof(Counts), stream), "cudaMemsetAsync");
        register_particles(frame, user_, launcher_);
        end_stage();
        sample_base_vertices(frame, launcher_);
        end_stage();
        split_cells(frame, user_, has_levels_, launcher_);
        end_stage();
        if (user_.mode == Mode::adaptive) adjust_levels(frame, launcher_);
        end_stage();
        sample_field(frame, launcher_);
        if (user_.mode == Mode::adaptive) sample_edge_middles(frame, launcher_);
        end_stage();
        emit(frame, end_stage);
    }

    /// From levels and samples to the mesh, and the counts to the host.
    template <class EndStage>
    void emit(const Frame& frame, const EndStage& end_stage) {
        count_triangles(frame, launcher_);
        end_stage();
        place_vertices(frame, launcher_);
        end_stage();
        emit_triangles(frame, launcher_);
        end_stage();
        fill_cracks(frame, launcher_);
        end_stage();
        check(cudaMemcpyAsync(host_counts_.get(), frame.counts, sizeof(Counts), cudaMemcpyDeviceToHost, stream_.get()),
              "cudaMemcpyAsync");
    }

    void tell(Statistics& statistics) const {
        statistics.field_evaluations = counts().field_evaluations;
        for (std::size_t level = 0; level < 3; ++level)
            statistics.base_cells_by_level[level] = counts().band_cells[level];
        for (std::size_t i = 0; i < order.size(); ++i)
            statistics.stage_seconds[static_cast<std::size_t>(order[i])] +=
                ends_[i].seconds_since(i == 0 ? start_ : ends_[i - 1]);
        statistics.backend = "cuda";
    }

    Settings user_;
    int device_;
    std::optional<CurrentDevice> at_end_;  ///< while the members below end, in whatever thread
    // A frame that failed may have left copies under way: pinned memory outlives the stream, whose end waits for them.
    Upload upload_;
    PinnedMemory host_counts_;
    std::shared_ptr<MeshStorage> storage_;
    Stream stream_;
    DeviceMemory memory_;
    Frame frame_;
    Launcher launcher_;
    Event start_;
    std::array<Event, order.size()> ends_;
    std::array<Graph, 2> graphs_;  ///< one for each set of mesh arrays
    std::array<std::weak_ptr<PendingMesh>, 2> pending_;
    std::size_t set_ = 0;             ///< that the last mesh went into
    bool one_set_has_to_do_ = false;  ///< a second one of these capacities was refused
    std::uint64_t particles_ = 0;     ///< of the last frame
    bool settled_ = false;            ///< whether the last frame needed no more room
    bool has_levels_ = false;
    bool capped_ = false;  ///< whether a mesh of the last frame was emitted with capped levels
};

}  // namespace

std::unique_ptr<BackendReconstruction> make_reconstruction(const Settings& settings, int device,
                                                           const std::shared_ptr<MemoryAccount>& account,
                                                           const std::shared_ptr<MemoryAccount>& device_account) {
    const CurrentDevice current(device);
    return std::make_unique<Reconstruction>(settings, device, account, device_account);
}

}  // namespace meniscus::cuda
