// The order of the paper's steps (Algorithms 1 to 3), written once: for the CPU, for CUDA, for their clocks and for the
// tests that put white noise in place of particles.
#pragma once

#include "meniscus/statistics.hpp"

namespace meniscus {

/// Steps 5 to 7 and Algorithm 3: from levels and samples to the mesh.
/// Steps: a step is a member function of its name; release() gives back memory that no later step needs. Clock:
/// enter(stage) is called where a stage begins.
template <class Steps, class Clock>
void emit_mesh(Steps& steps, Clock& clock) {
    clock.enter(Stage::count_triangles);
    steps.count_triangles();
    clock.enter(Stage::place_vertices);
    steps.place_vertices();
    steps.release();
    clock.enter(Stage::emit_triangles);
    steps.emit_triangles();
    clock.enter(Stage::fill_cracks);
    steps.fill_cracks();
}

/// A frame's whole way. Of a part of a frame, the cells of other parts have had their effect once the field is sampled.
/// Step 2 asks for the field at base vertices, which are part of step 4's samples. The volume is that of the whole
/// mesh, whatever levels are emitted later; its time counts as the last stage's.
template <class Steps, class Clock>
void run_pipeline(Steps& steps, Clock& clock) {
    clock.enter(Stage::register_particles);
    steps.register_particles();
    clock.enter(Stage::sample_field);
    steps.sample_base_vertices();
    clock.enter(Stage::split_cells);
    steps.split_cells();
    clock.enter(Stage::adjust_levels);
    if (steps.is_adaptive()) steps.adjust_levels();
    clock.enter(Stage::sample_field);
    steps.sample_field();
    if (steps.is_adaptive()) steps.sample_edge_middles();
    steps.leave_other_parts();
    emit_mesh(steps, clock);
    steps.measure_volume();
}

}  // namespace meniscus
