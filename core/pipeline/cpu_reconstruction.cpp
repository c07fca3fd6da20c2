// The way of a frame through the CPU backend: the paper's steps in their order.
#include "engine/cpu/particle_field.hpp"
#include "engine/cpu/split_cells.hpp"
#include "engine/cpu/surface.hpp"
#include "particles/particle_sets.hpp"
#include "pipeline/backend.hpp"
#include "processor.hpp"

namespace meniscus::cpu {
namespace {

class Reconstruction final : public BackendReconstruction {
public:
    Reconstruction(const Settings& user, unsigned threads, const std::shared_ptr<MemoryAccount>& account)
        : user_(user),
          settings_(user),
          workers_(threads),
          surface_(account, workers_, settings_),
          particles_(account, workers_, settings_),
          field_(account, workers_, particles_),
          counts_(make_array<std::uint32_t>(account)),
          reaches_(make_array<CellReach>(account)),
          bends_(make_array<CellBend>(account)),
          levels_(make_array<std::uint8_t>(account)) {}

    MeshDownload reconstruct(const ParticleFrame& frame, Mesh& mesh, Statistics& statistics) override {
        StageClock clock(statistics);
        clock.enter(Stage::register_particles);
        register_particles(frame);
        clock.enter(Stage::sample_field);
        field_.sample_base_vertices(surface_, reaches_);
        clock.enter(Stage::split_cells);
        find_band(surface_, reaches_);
        if (splits_by<CurvatureCriterion>()) field_.measure_bends(surface_, reaches_, bends_);
        const SplitRule rule = split_rule(frame);
        split_cells(surface_, rule);
        clock.enter(Stage::adjust_levels);
        if (user_.mode == Mode::adaptive) adjust_levels(surface_);
        clock.enter(Stage::sample_field);
        sample_field(surface_, field_, [&](std::uint32_t block) { return wanted_level(rule, surface_.view(), block); });
        if (user_.mode == Mode::adaptive) sample_edge_middles(surface_, field_);
        emit(mesh, clock);
        capped_ = false;

        statistics.field_evaluations = surface_.field_evaluations;
        statistics.base_cells_by_level = count_band_cells(surface_);
        statistics.backend = "cpu";
        statistics.threads = workers_.count();
        return {};
    }

    void emit_capped(int max_level, Mesh& mesh) override {
        if (!capped_) levels_.assign(surface_.level.begin(), surface_.level.end());
        capped_ = true;
        cap_levels(surface_, levels_, max_level);
        Statistics not_told;
        StageClock clock(not_told);
        emit(mesh, clock);
    }

private:
    /// From levels and samples to the mesh.
    void emit(Mesh& mesh, StageClock& clock) {
        clock.enter(Stage::count_triangles);
        count_triangles(surface_, mesh);
        clock.enter(Stage::place_vertices);
        place_vertices(surface_, field_, user_, mesh);
        clock.enter(Stage::emit_triangles);
        emit_triangles(surface_, mesh);
        clock.enter(Stage::fill_cracks);
        fill_cracks(surface_, mesh);
    }

    void register_particles(const ParticleFrame& frame) {
        particles_.assign(frame);
        particles_.mark_reached_cells(surface_.grid);
        number_members(surface_.grid, workers_);
        store_blocks(surface_);
        if (splits_by<CountCriterion>()) particles_.count_per_cell(surface_.grid, counts_);
        field_.begin_frame(user_.field);
    }

    template <class Chosen>
    bool splits_by() const {
        return user_.mode == Mode::adaptive && std::holds_alternative<Chosen>(user_.criterion);
    }

    SplitRule rule_of(const CurvatureCriterion& chosen, const ParticleFrame&) const {
        return CurvatureRule{bends_.data(), static_cast<float>(chosen.tolerance)};
    }
    SplitRule rule_of(const CountCriterion& chosen, const ParticleFrame& frame) const {
        return CountRule{counts_.data(), chosen.threshold, !frame.levels.empty()};
    }
    SplitRule split_rule(const ParticleFrame& frame) const {
        if (user_.mode == Mode::uniform) return UniformRule{};
        return std::visit([&](const auto& chosen) { return rule_of(chosen, frame); }, user_.criterion);
    }

    Settings user_;
    LatticeSettings settings_;
    Workers workers_;
    Surface surface_;
    ParticleSets particles_;
    ParticleField field_;
    Array<std::uint32_t> counts_;
    Array<CellReach> reaches_;
    Array<CellBend> bends_;
    Array<std::uint8_t> levels_;  ///< of the last frame, once a mesh of it was emitted with capped ones
    bool capped_ = false;
};

}  // namespace

std::unique_ptr<BackendReconstruction> make_reconstruction(const Settings& settings, unsigned threads,
                                                           const std::shared_ptr<MemoryAccount>& account) {
    require_supported_processor();
    return std::make_unique<Reconstruction>(settings, threads, account);
}

}  // namespace meniscus::cpu
