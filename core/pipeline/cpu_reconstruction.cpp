// The CPU backend: state, particles and field that live from frame to frame.
#include "field/kernels.hpp"
#include "neighbors/cpu/particle_field.hpp"
#include "particles/seams.hpp"
#include "pipeline/backend.hpp"
#include "pipeline/cpu_pipeline.hpp"
#include "pipeline/pipeline.hpp"
#include "pipeline/stage_clock.hpp"
#include "steps/fill_cracks/volume.hpp"

namespace meniscus::cpu {
namespace {

std::unique_ptr<FieldSource> make_field(const LatticeSettings& settings, NeighborSearch& search) {
    return with_kernel(settings, [&]<class Kernel>() -> std::unique_ptr<FieldSource> {
        return std::make_unique<ParticleField<Kernel>>(search);
    });
}

class Reconstruction final : public BackendReconstruction {
public:
    Reconstruction(const Settings& user, const BackendOptions& options, const std::shared_ptr<MemoryAccount>& account)
        : settings_(user),
          stop_(options.stop),
          keeps_lattice_(options.keep_lattice),
          workers_(options.threads, stop_.get()),
          state_(account, workers_, settings_),
          particles_(account, workers_, settings_),
          search_(account, workers_.count(), particles_),
          field_(make_field(settings_, search_)),
          found_levels_(make_array<std::uint8_t>(account)) {
        settings_.work_limit = options.work_limit;
    }

    MeshDownload reconstruct(const PlacedFrame& particles, Mesh& mesh, Statistics& statistics) override {
        StageClock clock(statistics);
        state_.attributes = particles.attributes;
        settings_.part = particles.part;
        ParticleSteps steps(state_, *field_, mesh, particles_, search_, particles);
        run_pipeline(steps, clock);
        if (keeps_lattice_) keep_lattice(state_, mesh);
        is_capped_ = false;

        mesh.spray.assign(particles_.spray.begin(), particles_.spray.end());
        statistics.spray_particles = particles_.spray_particles;
        statistics.volume = world_volume(state_.sixfold_volume, settings_.cell_size, settings_.offset_bits);
        statistics.field_evaluations = state_.field_evaluations;
        statistics.vertices_without_particles = state_.vertices_without_particles;
        statistics.base_cells_by_level = count_band_cells(state_);
        statistics.backend = "cpu";
        statistics.threads = workers_.count();
        return {};
    }

    void emit_capped(int max_level, Mesh& mesh) override {
        if (!is_capped_) found_levels_.assign(state_.level.begin(), state_.level.end());
        is_capped_ = true;
        cap_levels(state_, found_levels_, max_level);
        SurfaceSteps steps(state_, *field_, mesh);
        NoClock clock;
        emit_mesh(steps, clock);
        if (keeps_lattice_) keep_lattice(state_, mesh);
        mesh.spray.assign(particles_.spray.begin(), particles_.spray.end());
    }

    PartOutcome part_outcome() override {
        return {seams_of(settings_.part, state_.grid.keys, state_.border_hashes), state_.sixfold_volume, 0.0F};
    }

    float greatest_sample() override { return cpu::greatest_sample(state_); }

private:
    LatticeSettings settings_;
    std::shared_ptr<const StopFlag> stop_;
    bool keeps_lattice_;
    Workers workers_;
    State state_;
    ParticleSets particles_;
    NeighborSearch search_;
    std::unique_ptr<FieldSource> field_;
    Array<std::uint8_t> found_levels_;  ///< levels of the last frame, once a mesh of it was emitted with capped levels
    bool is_capped_ = false;
};

}  // namespace

template <>
std::unique_ptr<BackendReconstruction> make_reconstruction<InstructionSet::MENISCUS_INSTRUCTION_SET>(
    const Settings& settings, const BackendOptions& options, const std::shared_ptr<MemoryAccount>& account) {
    return std::make_unique<Reconstruction>(settings, options, account);
}

}  // namespace meniscus::cpu
