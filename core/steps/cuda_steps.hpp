// The paper's steps on the GPU. Each puts kernels on the launcher's stream and waits for nothing.
#pragma once

#include "engine/cuda/device_state.hpp"
#include "engine/cuda/launch.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::cuda {

/// Step 1. Also tells the frame which of its arrays hold the sorted keys.
void register_particles(Frame& frame, const Settings& user, const Launcher& launch);
/// Step 4's first part: the values at base vertices, and what a cell's particles may do in it.
void sample_base_vertices(const Frame& frame, const Launcher& launch);
/// Step 2: the band and the levels.
void split_cells(const Frame& frame, const Settings& user, bool has_particle_levels, const Launcher& launch);
/// The levels as sets of cells, after they have been given to all blocks at once.
void collect_level_sets(const Frame& frame, const Launcher& launch);
/// Step 3.
void adjust_levels(const Frame& frame, const Launcher& launch);
/// Step 4. Samples what the cells of the band need, until no cell joins the band or goes up for it.
void sample_field(const Frame& frame, const Launcher& launch);
/// Samples the middles of coarse edges that cross the surface.
void sample_edge_middles(const Frame& frame, const Launcher& launch);
/// After a frame: gives every cell the level that it had, or max_level where that is coarser, and takes back what was
/// counted from step 5 on. first: whether the frame's levels are still those that it found.
void cap_levels(const Frame& frame, int max_level, bool first, const Launcher& launch);
/// Step 5.
void count_triangles(const Frame& frame, const Launcher& launch);
/// Step 6. Also decides whether there is room for the mesh.
void place_vertices(const Frame& frame, const Launcher& launch);
/// Step 7.
void emit_triangles(const Frame& frame, const Launcher& launch);
/// Algorithm 3.
void fill_cracks(const Frame& frame, const Launcher& launch);

}  // namespace meniscus::cuda
