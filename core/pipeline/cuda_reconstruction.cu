// The CUDA backend: the runs of its frames (cuda_frame_run.hpp) and where their particles
// (engine/cuda/upload_areas.hpp) and meshes lie (pipeline/cuda_mesh_sets.hpp).
#include <memory>
#include <optional>

#include "pipeline/backend.hpp"
#include "pipeline/cuda_frame_run.hpp"
#include "steps/fill_cracks/volume.hpp"

namespace meniscus::cuda {
namespace {

class Reconstruction final : public BackendReconstruction {
public:
    Reconstruction(const Settings& settings, const BackendOptions& options,
                   const std::shared_ptr<MemoryAccount>& account, const std::shared_ptr<MemoryAccount>& device_account)
        : device_(options.device),
          sets_(device_, account, device_account),
          areas_(std::make_shared<UploadAreas>(device_, device_account)),
          run_(LatticeSettings(settings), options, sets_, *areas_, account, device_account) {}

    ~Reconstruction() override {
        try {
            at_end_.emplace(device_);
        } catch (...) {
            return;  // The device is lost: there is nothing to free on it.
        }
        sets_.give_back(run_.stream());
        areas_->close();
    }

    MeshDownload reconstruct(const PlacedFrame& particles, Mesh& mesh, Statistics& statistics) override {
        const DeviceMesh on_device = reconstruct_on_device(particles, statistics);
        run_.copy_spray(mesh.spray);
        return download(on_device, mesh);
    }

    void emit_capped(int max_level, Mesh& mesh) override {
        const CurrentDevice current(device_);
        const bool first = !is_capped_;
        is_capped_ = true;
        run_.emit_capped(max_level, first);
        run_.copy_spray(mesh.spray);
        download(mesh_on_device(), mesh).finish();
    }

    ParticlesByLevel validate_on_device(const ParticleFrame& frame, void* stream, const Settings& settings) override {
        const CurrentDevice current(device_);
        return run_.validate(frame, static_cast<cudaStream_t>(stream), settings);
    }

    DeviceMesh reconstruct_on_device(const PlacedFrame& particles, Statistics& statistics) override {
        const CurrentDevice current(device_);
        run_.run(particles);
        is_capped_ = false;
        statistics.spray_particles = run_.counts().spray_particles;
        const LatticeSettings& settings = run_.state().settings;
        statistics.volume = world_volume(run_.counts().sixfold_volume, settings.cell_size, settings.offset_bits);
        statistics.field_evaluations = run_.counts().field_evaluations;
        statistics.vertices_without_particles = run_.counts().vertices_without_particles;
        for (std::size_t level = 0; level < 3; ++level)
            statistics.base_cells_by_level[level] = run_.counts().band_cells[level];
        run_.clock().add_to(statistics);
        statistics.backend = "cuda";
        return mesh_on_device();
    }

    void pack_on_device(Mesh& mesh, const CodingOptions& options, std::span<const AttributeWish> wishes,
                        DevicePackedFrame& packed) override {
        const CurrentDevice current(device_);
        if (!run_.state().keeps_lattice)
            throw InvalidInput("the mesh came without its lattice, which packed bricks are made of: set keep_lattice");
        sets_.pack(mesh_with_lattice(mesh_on_device()), run_.needed(Resource::bricks), mesh, options, wishes, packed);
    }

    AttributeNumbers numbers_on_device(const ParticleFrame& frame) override {
        const CurrentDevice current(device_);
        return run_.find_numbers(frame);
    }

    std::shared_ptr<FrameSender> sender() override { return areas_; }

    PartOutcome part_outcome() override {
        const CurrentDevice current(device_);
        return {run_.seams(), run_.counts().sixfold_volume, 0.0F};
    }

    float greatest_sample() override {
        const CurrentDevice current(device_);
        return run_.greatest_sample();
    }

private:
    DeviceMesh mesh_on_device() {
        const State& state = run_.state();
        const Counts& counts = run_.counts();
        DeviceMesh mesh;
        mesh.vertices = state.vertices;
        mesh.normals = state.settings.has_normals ? state.normals : nullptr;
        mesh.triangles = state.triangles;
        for (std::uint32_t a = 0; a < state.attributes.arrays; ++a)
            mesh.attributes.emplace_back().data = state.vertex_attributes[a];
        mesh.vertex_count = static_cast<std::uint32_t>(run_.needed(Resource::vertices));
        mesh.triangle_count = static_cast<std::uint32_t>(run_.needed(Resource::triangles));
        for (std::size_t level = 0; level < triangle_level_count; ++level)
            mesh.levels[level] = {counts.first_triangle[level], static_cast<std::uint32_t>(counts.triangles[level])};
        mesh.cell_size = state.settings.cell_size;
        mesh.offset_bits = state.settings.offset_bits;
        mesh.device = device_;
        mesh.stream = run_.stream().get();
        return mesh;
    }

    MeshOnDevice mesh_with_lattice(const DeviceMesh& on_device) {
        const State& state = run_.state();
        MeshOnDevice from{.mesh = on_device, .bricks = state.mesh_bricks, .lattice = {}};
        if (state.keeps_lattice) {
            from.lattice = {.vertices = state.vertices,
                            .normals = on_device.normals,
                            .blocks = state.lattice_blocks,
                            .kept = state.kept_blocks,
                            .bricks = state.kept_bricks,
                            .offset_bits = on_device.offset_bits};
            from.lattice_blocks = static_cast<std::uint32_t>(run_.needed(Resource::lattice_blocks));
        }
        return from;
    }

    MeshDownload download(const DeviceMesh& on_device, Mesh& mesh) {
        return sets_.download(mesh_with_lattice(on_device), run_.needed(Resource::bricks), mesh);
    }

    int device_;
    std::optional<CurrentDevice> at_end_;  ///< makes the device current while the members below end, in any thread
    MeshSets sets_;
    std::shared_ptr<UploadAreas> areas_;  ///< lives until the last frame that was sent ahead is given up
    FrameRun run_;
    bool is_capped_ = false;  ///< whether a mesh of the last frame was emitted with capped levels
};

}  // namespace

std::unique_ptr<BackendReconstruction> make_reconstruction(const Settings& settings, const BackendOptions& options,
                                                           const std::shared_ptr<MemoryAccount>& account,
                                                           const std::shared_ptr<MemoryAccount>& device_account) {
    const CurrentDevice current(options.device);
    return std::make_unique<Reconstruction>(settings, options, account, device_account);
}

}  // namespace meniscus::cuda
