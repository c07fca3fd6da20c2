// The kernels of a frame by steps:
//
//   UploadAreas  the caller's arrays -> an area, on a stream of their own, of a frame that is sent ahead, while the one
//                before is worked at
//   Upload       the caller's arrays -> an area, of any other frame; FrameInput  (outside of the graph: its size is the
//                frame's)
//   register     make_keys, store_key_part, sort, mark_starts, scan, store_support_cells, store_particles,
//                stop_if_crowded; order_by_payload, store_numbers;
//                list_reached_bricks, sort, mark_first_keys, scan, store_bricks, mark_reached_cells, count_members;
//                scan, find_neighbors, find_each_neighbor_brick, make_blocks; sum_at_each_particle, and divide_weights
//                or fit_kernels, ...; or count_particles
//   sample       sample_base
//   split        collect_base_vertices, find_band, measure_band, choose_levels, list_level_sets
//   adjust       balance_and_promote                                        (cooperative)
//   sample       list_corner_points, sample_list, settle_band               (cooperative); of a part of
//                a frame hash_each_border (behind list_edge_middles, ...)
//   count        list_band, count_cells, count_cracks, scan, order_by_level_and_brick
//   place        count_vertices, scan, require_room, place_listed; place_group for each group of attributes' numbers
//   emit, fill   emit_cells, fill_listed, add_volumes; keep_bricks
//   Counts       -> pinned memory; the host waits
//   PendingMesh  the mesh -> the caller's arrays                            (when they ask for it, on a stream of its
//   own)
//
// Arrays of the caller's that are not pinned are copied through memory that is. What overlaps: a frame's kernels with
// the next one's upload and with the download of the mesh before, pieces of a copy through pinned memory with copying
// into it or out of it. Frames of different sessions take turns (engine/cuda/device_turn.hpp).
#include "pipeline/cuda_frame_run.hpp"

#include <algorithm>
#include <bit>
#include <mutex>
#include <string>
#include <utility>

#include "engine/cuda/device_turn.hpp"
#include "engine/growth.hpp"
#include "engine/index_limit.hpp"
#include "particles/seams.hpp"
#include "pipeline/cuda_pipeline.hpp"
#include "pipeline/pipeline.hpp"
#include "pipeline/stage_clock.hpp"
#include "steps/register_particles/crowd.hpp"
#include "steps/register_particles/work.hpp"

namespace meniscus::cuda {

FrameRun::FrameRun(const LatticeSettings& settings, const BackendOptions& options, MeshSets& sets, UploadAreas& areas,
                   const std::shared_ptr<MemoryAccount>& account, const std::shared_ptr<MemoryAccount>& device_account)
    : device_(options.device),
      stop_(options.stop),
      notice_(options.notice),
      sets_(sets),
      areas_(areas),
      upload_(account),
      host_counts_(account),
      account_(account),
      device_account_(device_account),
      memory_(device_, stream_.get(), device_account),
      state_(settings) {
    launcher_ = {stream_.get(), processors_of(device_), most_cooperative_blocks()};
    host_counts_.reserve(sizeof(Counts));
    state_.settings.work_limit = options.work_limit;
    state_.stop_word = stop_.word();
    state_.keeps_lattice = options.keep_lattice;
}

ParticlesByLevel FrameRun::validate(const ParticleFrame& on_device, cudaStream_t made_on, const Settings& settings) {
    if (!particle_check_) particle_check_.emplace(device_, launcher_, account_, device_account_);
    return particle_check_->require_valid(on_device, made_on, settings);
}

void FrameRun::run(const PlacedFrame& placed) {
    const ParticleFrame& particles = placed.frame;
    std::uint64_t payload_bytes = 0;
    for (const ParticleArray& array : particles.arrays) payload_bytes += array.data.size();
    const FrameParts parts{!particles.levels.empty(), payload_bytes != 0};
    // Graphs hold the settings.
    if (parts != parts_ || !(placed.part == state_.settings.part)) {
        drop_graphs();
        settled_ = false;  // other kernels run first, then are captured
    }
    parts_ = parts;
    state_.settings.part = placed.part;
    particles_ = particles.count();
    // A frame without particles may lack the arrays that the next one brings again.
    const AttributeShape shape = particles_ == 0 ? state_.attributes : placed.attributes.shape;
    const FrameArrays arrays = arrays_of(particles);
    const std::uint64_t ahead = particles.sent != nullptr ? particles.sent->number_of(&areas_) : 0;
    try {
        const bool grown = make_room({}, payload_bytes, shape);
        UploadAreas::Place place;
        sets_.with_room([&] { place = areas_.take(arrays, ahead, stream_); });
        areas_.with_room([&] { sets_.take(state_); });
        run_until_it_fits(placed, arrays, place, grown);
    } catch (...) {
        // The caller's arrays go back, and may be on their way to the device still.
        stream_.settle();
        areas_.give_back();
        throw;
    }
    areas_.give_back();
}

void FrameRun::run_until_it_fits(const PlacedFrame& placed, const FrameArrays& arrays, UploadAreas::Place place,
                                 bool grown) {
    for (;;) {
        run_once(placed, arrays, place, grown);
        require_whole_guards();
        if (counts().stop == Stop::none) break;
        require_no_refusal();
        make_more_room();
        grown = true;
    }
    settled_ = !grown;
}

void FrameRun::run_once(const PlacedFrame& placed, const FrameArrays& arrays, UploadAreas::Place& place, bool grown) {
    const std::lock_guard turn(turn_on(device_));
    if (stop_.is_raised()) throw Stopped();
    try {
        poison();
        clock_.start(stream_.get());
        if (!std::exchange(place.is_filled, true))
            upload_.send_particles(arrays, placed.on_device, place.begin, stream_.get());
        upload_.send_input(placed, arrays, place.begin, state_, stream_.get());
        CapturedRun& captured = current_graph();
        if (uses_graphs_ && !grown && settled_ && !captured.graph.is_captured()) capture(captured.graph);
        if (captured.graph.is_captured())
            captured.graph.launch(stream_.get());
        else
            enqueue(false);
        stream_.synchronize();
    } catch (...) {
        // The turn lasts until the kernels have ended that are on the stream already.
        stream_.settle();
        throw;
    }
}

void FrameRun::capture(Graph& graph) {
    try {
        graph.capture(stream_.get(), [&] { enqueue(true); });
    } catch (const std::exception& error) {
        // A graph saves time, and nothing else.
        uses_graphs_ = false;
        drop_graphs();
        if (notice_) notice_(std::string("frames run without graphs: ") + error.what());
    }
}

void FrameRun::emit_capped(int max_level, bool first) {
    areas_.with_room([&] { sets_.take(state_); });
    for (;; first = false) {
        sets_.poison(state_);
        cap_levels(state_, max_level, first, launcher_);
        with_kernel(state_.settings, [&]<class Kernel>() {
            SurfaceSteps<ParticleField<Kernel>> steps(state_, {}, launcher_);
            NoClock clock;
            emit_mesh(steps, clock);
        });
        if (state_.keeps_lattice) keep_lattice(state_, launcher_);
        fetch_counts();
        stream_.synchronize();
        require_whole_guards();
        if (counts().stop == Stop::none) break;
        require_no_refusal();
        make_more_room();
    }
}

void FrameRun::poison() {
    memory_.poison(state_.arrays());
    sets_.poison(state_);
}

void FrameRun::require_whole_guards() {
    memory_.require_whole_guards(state_.arrays());
    areas_.require_whole_guards();
    sets_.require_whole_guards(state_);
}

void FrameRun::require_no_refusal() const {
    const LatticeSettings& settings = state_.settings;
    const auto even = [&]<class EvenNear>(std::uint64_t places, EvenNear) {
        return even_work<EvenNear>(settings, places, [&](unsigned k) { return counts().has_level(k); });
    };
    switch (counts().stop) {
        case Stop::none:
        case Stop::too_little_room:
            return;
        case Stop::crowded:
            throw_crowded(counts().crowd, particles_);
        case Stop::too_much_at_particles:
            throw_too_much_work("the particles' places", work_at_particles(counts().neighbors, particles_),
                                even(particles_, EvenNeighbors{}), settings);
        case Stop::too_much_at_base_cells:
            throw_too_much_work("the base cells", static_cast<double>(counts().pairs),
                                even(needed(Resource::blocks), EvenNearBaseCell{}), settings);
        case Stop::too_many_base_cells: {
            double even_cells = 0.0;
            for (unsigned k = 0; k < particle_level_count; ++k)
                even_cells += even_base_cells(settings, k, counts().level_particles[k]);
            throw_too_many_base_cells(needed(Resource::blocks), even_cells, settings);
        }
        case Stop::asked_for:
            throw Stopped();
    }
}

void FrameRun::copy_spray(Array<Point>& spray) {
    if (!state_.settings.lists_spray) return;
    const CurrentDevice current(device_);
    spray.resize(counts().spray_particles);
    if (spray.empty()) return;
    check(cudaMemcpyAsync(spray.data(), state_.spray, spray.size() * sizeof(Point), cudaMemcpyDeviceToHost,
                          stream_.get()),
          "cudaMemcpyAsync");
    stream_.synchronize();
}

AttributeNumbers FrameRun::find_numbers(const ParticleFrame& on_device) {
    return particle_check_->find_numbers(on_device);
}

std::vector<Seam> FrameRun::seams() {
    const auto bricks = static_cast<std::size_t>(needed(Resource::bricks));
    std::vector<std::uint64_t> keys(bricks);
    std::vector<WordHash> hashes(bricks * neighbor_slots);
    const auto fetch = [&](auto& to, const auto* from) {
        if (bricks != 0)
            check(cudaMemcpyAsync(to.data(), from, to.size() * sizeof(*from), cudaMemcpyDeviceToHost, stream_.get()),
                  "cudaMemcpyAsync");
    };
    fetch(keys, state_.brick_keys);
    fetch(hashes, state_.border_hashes);
    stream_.synchronize();
    return seams_of(state_.settings.part, keys, hashes);
}

float FrameRun::greatest_sample() {
    find_greatest_sample(state_, launcher_);
    fetch_counts();
    stream_.synchronize();
    return std::bit_cast<float>(counts().greatest_sample);
}

void FrameRun::enqueue(bool captured) {
    // Sorting swaps arrays in the copy, and the next frame begins with them as they are laid out.
    State state = state_;
    check(cudaMemsetAsync(state.counts, 0, sizeof(Counts), stream_.get()), "cudaMemsetAsync");
    clock_.begin(stream_.get(), captured);
    with_kernel(state.settings, [&]<class Kernel>() {
        ParticleSteps<Kernel> steps(state, parts_, launcher_);
        run_pipeline(steps, clock_);
    });
    if (state.keeps_lattice) keep_lattice(state, launcher_);
    clock_.finish();
    fetch_counts();
}

void FrameRun::fetch_counts() {
    check(cudaMemcpyAsync(host_counts_.get(), state_.counts, sizeof(Counts), cudaMemcpyDeviceToHost, stream_.get()),
          "cudaMemcpyAsync");
}

FrameRun::CapturedRun& FrameRun::current_graph() {
    CapturedRun& run = graphs_[sets_.current()];
    if (const std::uint64_t version = sets_.version(sets_.current()); run.mesh_version != version) {
        run.graph.drop();
        run.mesh_version = version;
    }
    return run;
}

void FrameRun::drop_graphs() {
    for (CapturedRun& run : graphs_) run.graph.drop();
}

bool FrameRun::make_room(const Needed& needed, std::uint64_t payload_bytes, const AttributeShape& attributes) {
    const Capacities before = state_.capacity;
    const bool more_payload = payload_bytes > state_.payload_bytes;
    const bool has_borders = !state_.settings.part.is_whole;
    const bool other_arrays = attributes != state_.attributes || has_borders != has_borders_;
    if (!state_.capacity.grow_to(particles_, needed) && !more_payload && !other_arrays) return false;
    state_.attributes = attributes;
    has_borders_ = has_borders;
    sets_.forget_refusal();
    drop_graphs();
    if (state_.capacity.same_but_for_mesh(before) && !more_payload && !other_arrays) return true;
    if (more_payload) state_.payload_bytes = with_room_to_grow(payload_bytes);
    const Capacities& room = state_.capacity;
    const std::uint64_t sums =
        std::max({room.particles, room[Resource::reached_bricks], room[Resource::bricks], room[Resource::blocks]}) + 1;
    state_.scratch_bytes = scratch_bytes(room.particles, room[Resource::reached_bricks], sums);
    areas_.with_room([&] { sets_.with_room([&] { memory_.assign(state_.arrays()); }); });
    state_.upload_tables(stream_.get());
    return true;
}

void FrameRun::make_more_room() {
    require_indexable_counts();
    if (!make_room(counts().needed, 0, state_.attributes))
        throw DeviceError("reconstruction", "the counts contradict each other", device_);
    areas_.with_room([&] { sets_.with_room([&] { sets_.fit(state_); }); });
}

void FrameRun::require_indexable_counts() const {
    require_indexable(needed(Resource::reached_bricks), "the particles reach", "bricks, repetitions counted");
    require_indexable(needed(Resource::bricks), "the particles reach", "bricks", too_many(Resource::bricks));
    require_indexable(needed(Resource::blocks), "the frame reaches", "base cells");
    require_indexable(needed(Resource::samples), "the surface needs", "field samples");
    require_indexable(needed(Resource::triangles), "the surface has", "triangles");
    require_indexable(needed(Resource::vertices), "the surface has", "vertices");
    require_indexable(needed(Resource::lattice_blocks), "the surface's bricks reach", "base cells");
}

}  // namespace meniscus::cuda
