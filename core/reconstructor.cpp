#include "meniscus/reconstructor.hpp"

#include <chrono>
#include <thread>

#include "backends/backend.hpp"
#include "backends/cuda/device.hpp"
#include "meniscus/error.hpp"
#include "meniscus/memory.hpp"
#include "processor.hpp"

namespace meniscus {

void Mesh::clear() {
    vertices.clear();
    normals.clear();
    triangles.clear();
    bricks.clear();
    levels = {};
}

std::string_view version() { return MENISCUS_VERSION; }

BackendDescription describe_backend(Backend choice) {
    const std::string without_gpu = cuda::why_unavailable();
    if (choice == Backend::cuda) throw InvalidInput("the CUDA backend cannot be used: " + without_gpu);
    require_supported_processor();
    return {Backend::cpu, "cpu", processor_name(), choice == Backend::cpu ? "asked for" : without_gpu};
}

class Reconstructor::Impl {
public:
    Impl(const Settings& settings, const BackendOptions& options)
        : settings_(checked(settings)), account_(std::make_shared<MemoryAccount>(options.memory_limit)) {
        describe_backend(options.backend);
        threads_ = options.threads;
        backend_ = cpu::make_reconstruction(settings_, threads_, account_);
    }

    void reconstruct(const ParticleFrame& frame, Mesh& mesh) {
        mesh.clear();
        statistics_ = {};
        validate(frame, settings_);
        adopt(mesh);
        const std::uint64_t allocations = account_->allocations();
        const auto start = std::chrono::steady_clock::now();
        try {
            backend_->reconstruct(frame, mesh, statistics_);
        } catch (...) {
            // The arrays may have grown up to the limit: give them back, so that a smaller frame finds room.
            mesh = {};
            backend_ = cpu::make_reconstruction(settings_, threads_, account_);
            throw;
        }
        statistics_.total_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        statistics_.particles = frame.count();
        statistics_.vertices = mesh.vertices.size();
        statistics_.triangles = mesh.triangles.size();
        for (std::size_t level = 0; level < triangle_level_count; ++level)
            statistics_.triangles_by_level[level] = mesh.levels[level].count;
        statistics_.peak_bytes = account_->peak_bytes();
        statistics_.allocations = account_->allocations() - allocations;
    }

    const Statistics& statistics() const { return statistics_; }
    const Settings& settings() const { return settings_; }

private:
    static const Settings& checked(const Settings& settings) {
        validate(settings);
        return settings;
    }

    /// A mesh that is new here is charged to this reconstructor's account from now on.
    void adopt(Mesh& mesh) {
        if (mesh.vertices.get_allocator().account() != account_) {
            mesh.vertices = Array<LatticePosition>(AccountAllocator<LatticePosition>(account_));
            mesh.normals = Array<Normal>(AccountAllocator<Normal>(account_));
            mesh.triangles = Array<Triangle>(AccountAllocator<Triangle>(account_));
            mesh.bricks = Array<MeshBrick>(AccountAllocator<MeshBrick>(account_));
        }
        mesh.cell_size = world_cell_size(settings_);
        mesh.offset_bits = settings_.edge_points == EdgePoints::bisect ? settings_.bisection_steps + 1 : 6;
    }

    Settings settings_;
    std::shared_ptr<MemoryAccount> account_;
    unsigned threads_ = 0;
    std::unique_ptr<BackendReconstruction> backend_;
    Statistics statistics_;
};

Reconstructor::Reconstructor(const Settings& settings, const BackendOptions& options)
    : impl_(std::make_unique<Impl>(settings, options)) {}
Reconstructor::~Reconstructor() = default;
Reconstructor::Reconstructor(Reconstructor&&) noexcept = default;
Reconstructor& Reconstructor::operator=(Reconstructor&&) noexcept = default;

void Reconstructor::reconstruct(const ParticleFrame& frame, Mesh& mesh) { impl_->reconstruct(frame, mesh); }
const Statistics& Reconstructor::statistics() const { return impl_->statistics(); }
const Settings& Reconstructor::settings() const { return impl_->settings(); }

}  // namespace meniscus
