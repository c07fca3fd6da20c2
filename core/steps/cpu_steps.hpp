// The paper's steps on the CPU, as loops over the state. pipeline/pipeline.hpp calls them in their order.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "engine/cpu/state.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/particle_frame.hpp"
#include "neighbors/cpu/field_source.hpp"
#include "neighbors/cpu/neighbor_search.hpp"
#include "neighbors/cpu/particle_sets.hpp"
#include "steps/sample_field/slivers.hpp"

namespace meniscus::cpu {

/// Step 1: sorts a valid frame's particles, and stores the base cells that they reach. Throws LimitExceeded where the
/// particles crowd, or bring too much work.
void register_particles(State& state, ParticleSets& sets, NeighborSearch& search, const ParticleFrame& frame);
/// Its parts. Sorts the particles, reads their numbers for vertices, and finds their support cells.
void sort_particles(ParticleSets& sets, const ParticleFrame& frame, const AttributeNumbers& numbers);
/// Gives every particle a support that fits its neighbors, and the volume that it stands for: the smooth field.
void fit_supports(ParticleSets& sets, NeighborSearch& search);
/// Divides the particles' weights by the density at their places: the color field.
void divide_weights_by_density(ParticleSets& sets, NeighborSearch& search);
/// Fills `grid` with the base cells that a particle's support reaches; numbers stay to be given. Returns the pairs of a
/// base cell and a particle near it, about.
std::uint64_t mark_reached_cells(ParticleSets& sets, BrickGrid& grid);
/// Numbers the members of a grid whose bits are set, and finds its bricks' neighbors.
void number_members(BrickGrid& grid, Workers& workers);
/// Sizes the arrays for the grid's members; no point is sampled, no cell is in the band.
void store_blocks(State& state);

/// Step 4's first part: the value at every stored block's base vertex, and bounds of the field in the whole cell.
void sample_base_vertices(State& state, NeighborSearch& search);

/// Gives the level that the criterion asks for in a cell, 1 to 3.
using WantedLevel = std::function<int(std::uint32_t block)>;
/// Step 2: puts the stored cells that may hold surface into the band, and gives each the level that the criterion of
/// the settings asks for. Base vertices must be sampled. Returns the criterion, for cells that join the band later.
WantedLevel split_cells(State& state, NeighborSearch& search, bool has_particle_levels);
/// Finds the curvature of the surface in every cell of the band.
void measure_bends(State& state, NeighborSearch& search);

/// After levels have been given to all blocks at once: collects them as sets of cells, and lets all rules look at all
/// cells anew.
void collect_level_sets(State& state);
/// Step 3: balance and promotion among the cells of the band, until nothing changes.
void adjust_levels(State& state);
/// Once all is sampled: gives every cell its level of `levels`, or max_level where that is coarser. What coarser cells
/// need is sampled already, since it is part of what finer ones needed.
void cap_levels(State& state, const Array<std::uint8_t>& levels, int max_level);

/// Whether the points to sample are cells' corners or the middles of crossing edges; those of level-1 edges bring one
/// half's middle.
enum class Wanted : std::uint8_t { corners, middles };
/// Gives values to all wanted points of the chosen blocks that have none; signs follow.
void sample_wanted_points(State& state, FieldSource& field, Wanted wanted);
/// Step 4: samples what the cells of the band need; cells that the samples draw into the band are adjusted and sampled
/// in turn.
void sample_field(State& state, FieldSource& field, const WantedLevel& wanted_level, Slivers slivers = Slivers::raised);
/// Samples the middles of coarse edges that cross the surface.
void sample_edge_middles(State& state, FieldSource& field);
/// Of a settled part of a frame: fills State::border_hashes.
void hash_borders(State& state);
/// Takes the bricks that are not the part's own out of the level sets, so that nothing is made of their cells. Their
/// blocks keep their levels, which the cells beside them look at.
void leave_other_bricks(State& state);
/// The greatest value of all points that were sampled, inside the domain.
float greatest_sample(State& state);

/// Step 5: lists the mixed cells, counts their triangles, and gives each its place in the mesh.
void count_triangles(State& state, Mesh& mesh);
/// Number of cells of the band by level.
std::array<std::uint64_t, 3> count_band_cells(State& state);
/// Step 6: numbers and places the vertices, with normals and attributes.
void place_vertices(State& state, FieldSource& field, Mesh& mesh);
/// Step 7: writes the triangles of the cells.
void emit_triangles(State& state, Mesh& mesh);
/// Algorithm 3: writes the crack filling.
void fill_cracks(State& state, Mesh& mesh);
/// Adds up State::sixfold_volume.
void measure_volume(State& state, const Mesh& mesh);
/// Fills Mesh::lattice, once the mesh is there.
void keep_lattice(State& state, Mesh& mesh);

}  // namespace meniscus::cpu
