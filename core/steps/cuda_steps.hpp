// The paper's steps on the GPU. Each puts kernels on the launcher's stream and waits for nothing; pipeline/pipeline.hpp
// calls them in their order.
#pragma once

#include "engine/cuda/launch.hpp"
#include "engine/cuda/state.hpp"
#include "steps/sample_field/slivers.hpp"

namespace meniscus::cuda {

// Field: ParticleField, or what a test puts in its place; see there.

/// Step 1: sorts the particles, and stores the base cells that they reach. Also sets the
/// state's pointers to the arrays that hold the sorted keys. has_payload: whether State::sources is filled.
void register_particles(State& state, bool has_payload, const Launcher& launch);
/// Its parts. Sorts the particles, and finds their support cells and the bricks of these.
void sort_particles(State& state, bool has_payload, const Launcher& launch);
/// Orders equal particles by their payload, and reads their numbers for vertices.
void order_payload(const State& state, const Launcher& launch);
/// Gives every particle a support that fits its neighbors, and the volume that it stands for: the smooth field.
void fit_supports(const State& state, const Launcher& launch);
/// Divides the particles' weights by the density at their places: the color field.
void divide_weights_by_density(const State& state, const Launcher& launch);
/// Finds the bricks of particles near each brick of base cells.
void find_neighbor_bricks(const State& state, const Launcher& launch);
/// Marks the base cells that the particles reach in their bricks, which hold none so far; counts them.
void store_reached_cells(const State& state, const Launcher& launch);
/// Numbers the members of the bricks, whose bits are set and counted in members_before; makes their blocks, none of
/// them in the band.
void store_blocks(const State& state, const Launcher& launch);

/// Step 4's first part: the values at base vertices, and bounds of the field in the whole cell.
void sample_base_vertices(const State& state, const Launcher& launch);

/// Step 2: puts the stored cells that may hold surface into the band, and gives each the level that the criterion of
/// the settings asks for.
void split_cells(const State& state, bool has_particle_levels, const Launcher& launch);
/// Finds the curvature of the surface in every cell of the band.
void measure_bends(const State& state, const Launcher& launch);

/// After levels have been given to all blocks at once: collects them as sets of cells.
void collect_level_sets(const State& state, const Launcher& launch);
/// Step 3: balance and promotion among the cells of the band, until nothing changes.
void adjust_levels(const State& state, const Launcher& launch);
/// After a frame: gives every cell the level that it had, or max_level where that is coarser, and takes back what was
/// counted from step 5 on. Level sets stay as they are: no later step reads them. first: whether the levels are still
/// those that the frame found.
void cap_levels(const State& state, int max_level, bool first, const Launcher& launch);

/// Step 4: samples what the cells of the band need, until no cell joins the band or goes up for it.
template <Slivers slivers, class Field>
void sample_field(const State& state, const Field& field, const Launcher& launch);
/// Samples the middles of coarse edges that cross the surface.
template <class Field>
void sample_edge_middles(const State& state, const Field& field, const Launcher& launch);
/// Of a settled part of a frame: fills State::border_hashes. From here on, nothing is made of cells in bricks that are
/// not the part's own.
void hash_borders(const State& state, const Launcher& launch);
/// Puts the greatest value of all points that were sampled, inside the domain, into Counts::greatest_sample, which must
/// be 0.
void find_greatest_sample(const State& state, const Launcher& launch);

/// Step 5: counts the triangles, and gives each its place in the mesh.
void count_triangles(const State& state, const Launcher& launch);
/// Step 6: numbers and places the vertices, with normals. Also decides whether there is room for the mesh.
template <class Field>
void place_vertices(const State& state, const Field& field, const Launcher& launch);
/// The last part of step 6: attributes of vertices that have their places.
template <class Field>
void place_attributes(const State& state, const Field& field, const Launcher& launch);
/// Step 7: writes the triangles of the cells.
void emit_triangles(const State& state, const Launcher& launch);
/// Algorithm 3: writes the crack filling.
void fill_cracks(const State& state, const Launcher& launch);
/// After the mesh is counted and its vertices are numbered: keeps the lattice of each brick.
void keep_lattice(const State& state, const Launcher& launch);
/// Adds up Counts::sixfold_volume, which must be 0.
void measure_volume(const State& state, const Launcher& launch);

}  // namespace meniscus::cuda
