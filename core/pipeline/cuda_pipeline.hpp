// The steps of one frame on a GPU, as pipeline.hpp calls them: each puts kernels on the stream and waits for nothing.
#pragma once

#include "engine/cuda/launch.hpp"
#include "engine/cuda/state.hpp"
#include "neighbors/cuda/particle_field.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {

/// The steps from levels on: of the field they need values and normals alone. Field: see ParticleField.
template <class Field, Slivers slivers = Slivers::raised>
class SurfaceSteps {
public:
    SurfaceSteps(State& state, const Field& field, const Launcher& launch)
        : state_(state), field_(field), launch_(launch) {}

    bool is_adaptive() const { return state_.settings.is_adaptive; }
    void adjust_levels() { cuda::adjust_levels(state_, launch_); }
    void sample_field() { cuda::sample_field<slivers>(state_, field_, launch_); }
    void leave_other_parts() {
        if (!state_.settings.part.is_whole) cuda::hash_borders(state_, launch_);
    }
    void sample_edge_middles() { cuda::sample_edge_middles(state_, field_, launch_); }
    void count_triangles() { cuda::count_triangles(state_, launch_); }
    void place_vertices() { cuda::place_vertices(state_, field_, launch_); }
    /// Gives nothing back: later frames use the same arrays.
    void release() {}
    void emit_triangles() { cuda::emit_triangles(state_, launch_); }
    void fill_cracks() { cuda::fill_cracks(state_, launch_); }
    void measure_volume() { cuda::measure_volume(state_, launch_); }

protected:
    State& state_;
    Field field_;
    const Launcher& launch_;
};

/// The parts of a frame beside positions, by which kernels are chosen.
struct FrameParts {
    bool levels = false;
    bool payload = false;
    bool operator==(const FrameParts&) const = default;
};

/// All steps of a frame of particles, which are on their way to State::input.
template <class Kernel>
class ParticleSteps : public SurfaceSteps<ParticleField<Kernel>> {
public:
    ParticleSteps(State& state, const FrameParts& parts, const Launcher& launch)
        : SurfaceSteps<ParticleField<Kernel>>(state, {}, launch), parts_(parts) {}

    void register_particles() { cuda::register_particles(this->state_, parts_.payload, this->launch_); }
    void sample_base_vertices() { cuda::sample_base_vertices(this->state_, this->launch_); }
    void split_cells() { cuda::split_cells(this->state_, parts_.levels, this->launch_); }

private:
    FrameParts parts_;
};

}  // namespace meniscus::cuda
