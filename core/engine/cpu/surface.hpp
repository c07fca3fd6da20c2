// The state of the surface stages between particles and mesh, and the stages as loops over it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>

#include "engine/arrays.hpp"
#include "engine/cpu/field_source.hpp"
#include "engine/cpu/workers.hpp"
#include "field/lattice_settings.hpp"
#include "lattice/blocks.hpp"
#include "lattice/level_sets.hpp"
#include "lattice/sign_sets.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::cpu {

/// What must look again at a cell after a level near it has changed.
enum class StaleFor : std::uint8_t { balance, promotion, corner_points, band, slivers };
inline constexpr std::array all_rules{StaleFor::balance, StaleFor::promotion, StaleFor::corner_points, StaleFor::band,
                                      StaleFor::slivers};

struct Surface {
    Surface(const std::shared_ptr<MemoryAccount>& account, Workers& workers, const LatticeSettings& settings);

    Workers& workers;
    const LatticeSettings& settings;

    BrickGrid grid;  ///< the stored base cells (blocks)
    // One element per block; BlocksView explains them.
    Array<std::uint32_t> brick;
    Array<std::uint16_t> place;
    Array<std::uint8_t> level;
    Array<BlockMask> sampled;
    Array<BlockMask> inside;
    Array<BlockMask> wanted_points;  ///< of chosen blocks
    Array<std::uint32_t> first_sample;
    Array<EdgeMasks> edges;
    Array<std::uint32_t> first_vertex;
    Array<TriangleSlots> slots;
    Array<float> samples;
    Array<std::uint32_t> mixed_cells;  ///< the cells of the surface band that see both signs, ascending
    Array<std::uint8_t> has_cracks;    ///< for each of them, whether any of its faces is to be filled
    Array<std::array<std::uint32_t, triangle_level_count>> brick_triangles;  ///< per brick and level
    Array<std::uint64_t> brick_counts;  ///< while a brick's samples or vertices are counted and numbered
    // Sets of base cells, see CellSetView.
    Array<std::uint64_t> any_inside, all_inside;               ///< see SignSets
    Array<std::uint64_t> base_deep;                            ///< see BaseVertexSets
    std::array<Array<std::uint64_t>, 3> at_least;              ///< by level, from 1; follow `level`
    Array<std::uint64_t> chosen;                               ///< by a pass, for the next one
    std::array<Array<std::uint64_t>, all_rules.size()> stale;  ///< by rule
    std::uint64_t field_evaluations = 0;

    BlocksView view();
    LevelSets level_sets();
    CellSetView stale_cells(StaleFor rule) { return {grid.view(), stale[static_cast<std::size_t>(rule)].data()}; }
    SignSets sign_sets() { return {{grid.view(), any_inside.data()}, {grid.view(), all_inside.data()}}; }
    CellSetView chosen_cells() { return {grid.view(), chosen.data()}; }
    std::uint32_t block_count() const { return grid.members; }
};

/// Sizes the arrays for the grid's members; no point is sampled, no cell is in the band.
void store_blocks(Surface& surface);

/// Numbers the members of a grid whose bits are set, and finds its bricks' neighbors.
void number_members(BrickGrid& grid, Workers& workers);

/// After levels have been given to all blocks at once: everything that follows from levels is to be found anew.
void levels_are_new(Surface& surface);

/// Step 3. Balance and promotion among the cells of the band, until nothing changes.
void adjust_levels(Surface& surface);

/// Whether the points to sample are cells' corners or the middles of crossing edges; those of level-1 edges bring one
/// half's middle.
enum class Wanted : std::uint8_t { corners, middles };
/// Gives values to all wanted points of the chosen blocks that have none; signs follow.
void sample_wanted_points(Surface& surface, FieldSource& field, Wanted wanted);
/// The level of a cell that joins the band.
using JoiningLevel = std::function<int(std::uint32_t block)>;
/// Step 4. Samples what the cells of the band need; cells that the samples draw into the band are adjusted and sampled
/// in turn.
void sample_field(Surface& surface, FieldSource& field, const JoiningLevel& joining_level);
/// One pass of that: samples the corner points of the cells whose surroundings have changed.
void sample_corner_points(Surface& surface, FieldSource& field);
/// Takes the cells into the band that a neighbor's samples show to hold surface; returns whether there were any.
bool grow_band(Surface& surface, const JoiningLevel& joining_level);
/// Raises the cells by one level that would cut off a finer neighbor's surface in a sliver; returns whether there were
/// any.
bool raise_at_slivers(Surface& surface);
/// Samples the middles of coarse edges that cross the surface.
void sample_edge_middles(Surface& surface, FieldSource& field);

/// Once all is sampled: gives every cell its level of `levels`, or max_level where that is coarser. What coarser cells
/// need is sampled already, since it is part of what finer ones needed.
void cap_levels(Surface& surface, const Array<std::uint8_t>& levels, int max_level);

/// Step 5. Lists the mixed cells, counts, and gives each its place in the mesh.
void count_triangles(Surface& surface, Mesh& mesh);
/// By level.
std::array<std::uint64_t, 3> count_band_cells(Surface& surface);
/// Step 6.
void place_vertices(Surface& surface, FieldSource& field, const Settings& user, Mesh& mesh);
/// Step 7.
void emit_triangles(Surface& surface, Mesh& mesh);
/// Algorithm 3.
void fill_cracks(Surface& surface, Mesh& mesh);

}  // namespace meniscus::cpu
