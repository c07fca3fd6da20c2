// Validation, accounts and statistics around a backend.
#include "meniscus/reconstructor.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <future>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/instruction_set.hpp"
#include "base/processor.hpp"
#include "codec/coded_bits.hpp"
#include "engine/cuda/device.hpp"
#include "meniscus/devices.hpp"
#include "meniscus/error.hpp"
#include "meniscus/memory.hpp"
#include "particles/attribute_choice.hpp"
#include "particles/placed_frame.hpp"
#include "particles/seams.hpp"
#include "particles/validation.hpp"
#include "particles/warnings.hpp"
#include "pipeline/backend.hpp"
#include "steps/register_particles/crowd.hpp"

namespace meniscus {
namespace {

/// A frame whose arrays are device pointers.
ParticleFrame frame_on_device(const DeviceParticleFrame& particles) {
    if (particles.count != 0 && particles.positions == nullptr)
        throw InvalidInput("the frame has " + std::to_string(particles.count) +
                           " particles on the GPU, but its positions are null");
    if (particles.count > std::numeric_limits<std::size_t>::max() / 3)
        throw LimitExceeded("the frame has " + std::to_string(particles.count) +
                            " particles, more than memory can hold");
    ParticleFrame frame;
    frame.positions = {particles.positions, 3 * particles.count};
    if (particles.levels != nullptr) frame.levels = {particles.levels, particles.count};
    frame.arrays = particles.arrays;
    return frame;
}

}  // namespace

void Mesh::clear() {
    spray.clear();
    vertices.clear();
    normals.clear();
    triangles.clear();
    bricks.clear();
    lattice.blocks.clear();
    lattice.bricks.clear();
    for (MeshAttribute& attribute : attributes) attribute.data.clear();
    levels = {};
}

BackendDescription describe_backend(Backend choice, int device) {
    const std::string without_gpu = cuda::why_unavailable(device);
    if (choice == Backend::cuda && !without_gpu.empty())
        throw InvalidInput("the CUDA backend cannot be used: " + without_gpu);
    const char* const asked_for = "asked for";
    if (choice != Backend::cpu && without_gpu.empty())
        return {Backend::cuda, "cuda", cuda::device_name(device), choice == Backend::cuda ? asked_for : "a usable GPU"};
    const std::string instructions(name_of(chosen_instruction_set()));
    return {Backend::cpu, "cpu", processor_name() + ", " + instructions,
            choice == Backend::cpu ? asked_for : without_gpu};
}

class Reconstructor::Impl {
public:
    Impl(const Settings& settings, const BackendOptions& options)
        : settings_(checked(settings)),
          attributes_(settings),
          attributes_to_send_(settings),
          options_(options),
          device_account_(std::make_shared<MemoryAccount>(options.device_memory_limit, "on the GPU",
                                                          options.shared_device_memory)) {
        if (options.threads > max_threads)
            throw InvalidInput("the threads are " + std::to_string(options.threads) + ", must be at most " +
                               std::to_string(max_threads));
        options_.backend = describe_backend(options.backend, options.device).backend;
        if (options_.backend == Backend::cpu)
            options_.pinning = nullptr;
        else if (options_.pinning == nullptr)
            options_.pinning = cuda::page_pinning(options.device);
        account_ =
            std::make_shared<MemoryAccount>(options.memory_limit, "in memory", options.shared_memory, options_.pinning);
        make_backend();
    }

    /// Frame, here and below: ParticleFrame or DeviceParticleFrame.
    template <class Frame>
    void reconstruct(const Frame& frame, Mesh& mesh) {
        fill(frame, mesh, [&](const PlacedFrame& particles) { download(particles, mesh); });
    }

    void reconstruct_last(const ParticleFrame& frame, Mesh& mesh) {
        fill(frame, mesh, [&](PlacedFrame particles) {
            particles.is_last = true;
            download(particles, mesh);
        });
        release_memory();
    }

    PartOutcome reconstruct_part(const ParticleFrame& frame, const FramePart& part, Mesh& mesh) {
        validate(part);
        mesh.clear();
        ValidFrame valid = begin(frame);
        valid.particles.part = lattice_part(part);
        set_ranges(valid.particles.attributes, valid.attributes, part.ranges);
        adopt(mesh);
        PartOutcome outcome;
        try {
            measure(valid, [&] {
                download(valid.particles, mesh);
                outcome = backend_->part_outcome();
                if (mesh.triangles.empty()) outcome.greatest_sample = backend_->greatest_sample();
                count(mesh.vertices.size(), mesh.triangles.size(), mesh.levels);
            });
        } catch (...) {
            mesh = {};
            throw;
        }
        return outcome;
    }

    template <class Frame>
    MeshDownload reconstruct_for_download(const Frame& frame, Mesh& mesh) {
        MeshDownload download;
        fill(frame, mesh,
             [&](const PlacedFrame& particles) { download = backend_->reconstruct(particles, mesh, statistics_); });
        return download;
    }

    void emit_capped(int max_level, Mesh& mesh) {
        if (max_level < 1 || max_level > 3)
            throw InvalidInput("a level cap of " + std::to_string(max_level) + "; levels are 1 to 3");
        if (!has_surface_) throw InvalidInput("there is no surface to emit again: reconstruct a frame first");
        mesh.clear();
        adopt(mesh);
        try {
            backend_->emit_capped(max_level, mesh);
        } catch (...) {
            mesh = {};
            has_surface_ = false;
            drop_backend();
            throw;
        }
    }

    template <class Frame>
    DeviceMesh reconstruct_on_device(const Frame& frame) {
        DeviceMesh mesh;
        const ValidFrame valid = begin(frame);
        measure(valid, [&] {
            auto wrong_radius = check_radius(valid);
            mesh = backend_->reconstruct_on_device(valid.particles, statistics_);
            attributes_.describe(mesh.attributes);
            count(mesh.vertex_count, mesh.triangle_count, mesh.levels);
            warn(valid, wrong_radius.get());
        });
        return mesh;
    }

    DevicePackedFrame pack_on_device(const CodingOptions& options, std::span<const AttributeWish> wishes) {
        if (!has_surface_) throw InvalidInput("there is no surface to pack: reconstruct a frame first");
        Mesh mesh;
        adopt(mesh);
        DevicePackedFrame frame;
        frame.cell_size = mesh.cell_size;
        frame.offset_bits = encoded_offset_bits(mesh, options);
        check_normal_bits(options.normal_bits);
        backend_->pack_on_device(mesh, options, wishes, frame);
        return frame;
    }

    FrameUpload send_ahead(const ParticleFrame& frame) noexcept {
        std::shared_ptr<FrameSender> sender;
        {
            const std::lock_guard lock(sender_mutex_);
            sender = sender_;
        }
        if (sender == nullptr) return {};
        try {
            validate_lengths(frame);
            const std::vector<ParticleArray> attributes = attributes_to_send_.of(frame);
            ParticleFrame chosen = frame;
            chosen.arrays = attributes;
            if (const std::uint64_t number = sender->send(chosen); number != 0) return {std::move(sender), number};
        } catch (const std::exception&) {
            // Its reconstruction refuses it with the reason.
        }
        return {};
    }

    void release_memory() {
        has_surface_ = false;
        drop_backend();
    }

    void limit_memory(std::size_t bytes) { account_->set_limit(bytes); }

    const Statistics& statistics() const { return statistics_; }
    const Settings& settings() const { return settings_; }

private:
    static const Settings& checked(const Settings& settings) {
        validate(settings);
        return settings;
    }

    void make_backend() {
        backend_ = options_.backend == Backend::cuda
                       ? cuda::make_reconstruction(settings_, options_, account_, device_account_)
                       : cpu::make_reconstruction(settings_, options_, account_);
        set_sender(backend_->sender());
    }
    void drop_backend() {
        set_sender(nullptr);
        backend_.reset();
    }
    void set_sender(std::shared_ptr<FrameSender> sender) {
        const std::lock_guard lock(sender_mutex_);
        sender_.swap(sender);
    }

    struct ValidFrame {
        std::vector<ParticleArray> attributes;  ///< the frame's arrays
        PlacedFrame particles;
        ParticlesByLevel by_level{};
    };

    // Validation comes before the last surface is forgotten: a frame that is refused changes nothing.
    ValidFrame begin(const ParticleFrame& frame) {
        ValidFrame valid = with_attributes(frame, false);
        validate_places(frame, settings_);
        valid.particles.attributes = numbers_in_host_memory(valid.attributes);
        valid.by_level = count_levels(frame);
        attributes_.keep(valid.attributes);
        forget_last_frame();
        if (!backend_) make_backend();
        return valid;
    }
    ValidFrame begin(const DeviceParticleFrame& particles) {
        ValidFrame valid = with_attributes(frame_on_device(particles), true);
        const ParticleFrame& frame = valid.particles.frame;
        if (!backend_) make_backend();
        try {
            valid.by_level = backend_->validate_on_device(frame, particles.stream, settings_);
            valid.particles.attributes = backend_->numbers_on_device(frame);
        } catch (const InvalidInput&) {
            throw;
        } catch (...) {
            forget_last_frame();
            drop_backend();
            throw;
        }
        attributes_.keep(valid.attributes);
        forget_last_frame();
        return valid;
    }
    /// Arrays that do not become attributes are passed over from here on.
    ValidFrame with_attributes(const ParticleFrame& frame, bool on_device) const {
        validate_lengths(frame);
        ValidFrame valid{attributes_.of(frame), {frame, on_device}};
        valid.particles.frame.arrays = valid.attributes;
        return valid;
    }
    void forget_last_frame() {
        statistics_ = {};
        has_surface_ = false;
    }

    /// call: to the backend, with this mesh.
    template <class Frame, class Call>
    void fill(const Frame& frame, Mesh& mesh, const Call& call) {
        mesh.clear();
        const ValidFrame valid = begin(frame);
        adopt(mesh);
        try {
            measure(valid, [&] {
                auto wrong_radius = check_radius(valid);
                call(valid.particles);
                count(mesh.vertices.size(), mesh.triangles.size(), mesh.levels);
                warn(valid, wrong_radius.get());
            });
        } catch (...) {
            mesh = {};
            throw;
        }
    }

    void download(const PlacedFrame& particles, Mesh& mesh) {
        const MeshDownload download = backend_->reconstruct(particles, mesh, statistics_);
        download.finish();
        statistics_.download_seconds = download.seconds();
    }

    /// Times a call to the backend with what follows from its result, and counts memory.
    template <class Call>
    void measure(const ValidFrame& frame, const Call& call) {
        const auto allocations = [&] { return account_->allocations() + device_account_->allocations(); };
        const std::uint64_t before = allocations();
        const auto start = std::chrono::steady_clock::now();
        try {
            call();
        } catch (const Stopped&) {
            throw;  // giving back much memory would take long
        } catch (const Crowded& crowded) {
            drop_backend();
            throw LimitExceeded(crowded.what() + fitting_radius_hint(frame.particles, settings_));
        } catch (...) {
            // The arrays may have grown up to the limit, or a device may have failed: the next frame begins afresh.
            drop_backend();
            throw;
        }
        has_surface_ = true;
        statistics_.total_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        statistics_.particles = frame.particles.frame.count();
        statistics_.particle_volume = volume_of(frame.by_level, settings_);
        statistics_.peak_bytes = account_->peak_bytes();
        statistics_.device_bytes = device_account_->bytes();
        statistics_.device_peak_bytes = device_account_->peak_bytes();
        statistics_.allocations = allocations() - before;
    }

    /// Holds the radius against the spacing of a frame, which must stay until the result is there: beside a GPU's work,
    /// which takes about as long, and else once the result is asked for.
    std::future<std::optional<Warning>> check_radius(const ValidFrame& frame) const {
        const auto check = [this, &frame] { return find_wrong_radius(frame.particles, settings_); };
        try {
            if (options_.backend == Backend::cuda) return std::async(std::launch::async, check);
        } catch (const std::system_error&) {
            // No thread is to be had: it comes after the frame.
        }
        return std::async(std::launch::deferred, check);
    }

    /// Finds the warnings of the frame just reconstructed, whose triangles are counted.
    void warn(const ValidFrame& frame, std::optional<Warning> wrong_radius) {
        find_warnings(
            frame.particles, frame.by_level, settings_, std::move(wrong_radius),
            [this] { return backend_->greatest_sample(); }, statistics_);
    }

    void count(std::size_t vertices, std::size_t triangles,
               const std::array<TriangleRange, triangle_level_count>& levels) {
        statistics_.vertices = vertices;
        statistics_.triangles = triangles;
        for (std::size_t level = 0; level < triangle_level_count; ++level)
            statistics_.triangles_by_level[level] = levels[level].count;
    }

    /// A mesh that is new here is charged to this reconstructor's account from now on.
    void adopt(Mesh& mesh) {
        if (mesh.vertices.get_allocator().account() != account_) {
            mesh.vertices = Array<LatticePosition>(AccountAllocator<LatticePosition>(account_));
            mesh.normals = Array<Normal>(AccountAllocator<Normal>(account_));
            mesh.triangles = Array<Triangle>(AccountAllocator<Triangle>(account_));
            mesh.bricks = Array<MeshBrick>(AccountAllocator<MeshBrick>(account_));
            mesh.spray = Array<Point>(AccountAllocator<Point>(account_));
            mesh.lattice = {.blocks = Array<LatticeBlock>(AccountAllocator<LatticeBlock>(account_)),
                            .bricks = Array<LatticeRange>(AccountAllocator<LatticeRange>(account_))};
        }
        attributes_.shape(mesh, account_);
        mesh.cell_size = world_cell_size(settings_);
        mesh.offset_bits = offset_bits(settings_);
    }

    Settings settings_;
    AttributeChoice attributes_;
    const AttributeChoice attributes_to_send_;  ///< does not change, since another thread may read it
    BackendOptions options_;
    std::shared_ptr<MemoryAccount> account_;
    std::shared_ptr<MemoryAccount> device_account_;
    std::unique_ptr<BackendReconstruction> backend_;  ///< none after a failure
    std::mutex sender_mutex_;
    std::shared_ptr<FrameSender> sender_;  ///< the backend's sender; used with the mutex held
    bool has_surface_ = false;             ///< whether the backend has a surface of the last frame
    Statistics statistics_;
};

Reconstructor::Reconstructor(const Settings& settings, const BackendOptions& options)
    : impl_(std::make_unique<Impl>(settings, options)) {}
Reconstructor::~Reconstructor() = default;
Reconstructor::Reconstructor(Reconstructor&&) noexcept = default;
Reconstructor& Reconstructor::operator=(Reconstructor&&) noexcept = default;

void Reconstructor::reconstruct(const ParticleFrame& frame, Mesh& mesh) {
    impl_->reconstruct(frame, mesh);
}
MeshDownload Reconstructor::reconstruct_for_download(const ParticleFrame& frame, Mesh& mesh) {
    return impl_->reconstruct_for_download(frame, mesh);
}
PartOutcome Reconstructor::reconstruct_part(const ParticleFrame& frame, const FramePart& part, Mesh& mesh) {
    return impl_->reconstruct_part(frame, part, mesh);
}
FrameUpload Reconstructor::send_ahead(const ParticleFrame& frame) noexcept {
    return impl_->send_ahead(frame);
}
DevicePackedFrame Reconstructor::pack_on_device(const CodingOptions& options, std::span<const AttributeWish> wishes) {
    return impl_->pack_on_device(options, wishes);
}
void Reconstructor::emit_capped(int max_level, Mesh& mesh) {
    impl_->emit_capped(max_level, mesh);
}
DeviceMesh Reconstructor::reconstruct_on_device(const ParticleFrame& frame) {
    return impl_->reconstruct_on_device(frame);
}
void Reconstructor::reconstruct_last(const ParticleFrame& frame, Mesh& mesh) {
    impl_->reconstruct_last(frame, mesh);
}
void Reconstructor::release_memory() {
    impl_->release_memory();
}

void Reconstructor::reconstruct(const DeviceParticleFrame& frame, Mesh& mesh) {
    impl_->reconstruct(frame, mesh);
}
MeshDownload Reconstructor::reconstruct_for_download(const DeviceParticleFrame& frame, Mesh& mesh) {
    return impl_->reconstruct_for_download(frame, mesh);
}
DeviceMesh Reconstructor::reconstruct_on_device(const DeviceParticleFrame& frame) {
    return impl_->reconstruct_on_device(frame);
}

void Reconstructor::limit_memory(std::size_t bytes) {
    impl_->limit_memory(bytes);
}
const Statistics& Reconstructor::statistics() const {
    return impl_->statistics();
}
const Settings& Reconstructor::settings() const {
    return impl_->settings();
}

}  // namespace meniscus
