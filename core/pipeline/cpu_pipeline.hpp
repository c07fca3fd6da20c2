// The steps of one frame on the CPU, as pipeline.hpp calls them.
#pragma once

#include <utility>

#include "engine/cpu/state.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/particle_frame.hpp"
#include "neighbors/cpu/field_source.hpp"
#include "neighbors/cpu/neighbor_search.hpp"
#include "particles/placed_frame.hpp"
#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {

/// The steps from levels on: of the field they need values and normals alone. `mesh` takes the result.
class SurfaceSteps {
public:
    SurfaceSteps(State& state, FieldSource& field, Mesh& mesh) : state_(state), field_(field), mesh_(mesh) {}

    bool is_adaptive() const { return state_.settings.is_adaptive; }
    void adjust_levels() { cpu::adjust_levels(state_); }
    void sample_field() { cpu::sample_field(state_, field_, wanted_level_, slivers_); }
    void leave_other_parts() {
        if (state_.settings.part.is_whole) return;
        cpu::hash_borders(state_);
        cpu::leave_other_bricks(state_);
    }
    void sample_edge_middles() { cpu::sample_edge_middles(state_, field_); }
    void count_triangles() { cpu::count_triangles(state_, mesh_); }
    void place_vertices() { cpu::place_vertices(state_, field_, mesh_); }
    /// Gives nothing back: the surface may be emitted once more.
    void release() {}
    void emit_triangles() { cpu::emit_triangles(state_, mesh_); }
    void fill_cracks() { cpu::fill_cracks(state_, mesh_); }
    void measure_volume() { cpu::measure_volume(state_, mesh_); }

protected:
    State& state_;
    FieldSource& field_;
    Mesh& mesh_;
    WantedLevel wanted_level_;  ///< criterion for cells that join the band
    Slivers slivers_ = Slivers::raised;
};

/// All steps of a frame of particles.
class ParticleSteps : public SurfaceSteps {
public:
    ParticleSteps(State& state, FieldSource& field, Mesh& mesh, ParticleSets& sets, NeighborSearch& search,
                  const PlacedFrame& particles)
        : SurfaceSteps(state, field, mesh),
          sets_(sets),
          search_(search),
          frame_(particles.frame),
          is_last_(particles.is_last) {}

    void register_particles() { cpu::register_particles(state_, sets_, search_, frame_); }
    void sample_base_vertices() { cpu::sample_base_vertices(state_, search_); }
    void split_cells() { wanted_level_ = cpu::split_cells(state_, search_, !frame_.levels.empty()); }
    /// Gives back samples and particles of a frame that no other follows.
    void release() {
        // The greatest sample is looked up where no triangle is.
        if (!is_last_ || mesh_.vertices.empty()) return;
        state_.release_samples();
        sets_.release();
    }

private:
    ParticleSets& sets_;
    NeighborSearch& search_;
    const ParticleFrame& frame_;
    bool is_last_;
};

}  // namespace meniscus::cpu
