// The data of the steps on the CPU, between particles and mesh.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "engine/arrays.hpp"
#include "engine/block_state.hpp"
#include "engine/cpu/workers.hpp"
#include "field/lattice_settings.hpp"
#include "lattice/level_sets.hpp"
#include "lattice/raise_times.hpp"
#include "lattice/sign_sets.hpp"
#include "lattice/word_hash.hpp"
#include "meniscus/mesh.hpp"
#include "particles/attributes.hpp"

namespace meniscus::cpu {

/// The rules that must look again at a cell after a level near it has changed.
enum class StaleFor : std::uint8_t { balance, promotion, corner_points, band, slivers };
inline constexpr std::array all_rules{StaleFor::balance, StaleFor::promotion, StaleFor::corner_points, StaleFor::band,
                                      StaleFor::slivers};

/// The places of a base cell's triangles, as indices into the mesh.
struct TriangleSlots {
    std::uint32_t cells;   ///< its own marching-cubes triangles
    std::uint32_t cracks;  ///< the crack filling of its faces
};

struct State : BlockState<Array> {
    State(const std::shared_ptr<MemoryAccount>& account, Workers& workers, const LatticeSettings& settings);

    Workers& workers;
    const LatticeSettings& settings;

    BrickGrid grid;                    ///< the stored base cells (blocks)
    Array<TriangleSlots> slots;        ///< places of every block that is a mixed cell
    Array<std::uint32_t> mixed_cells;  ///< the cells of the surface band that see both signs, ascending
    Array<std::uint8_t> is_cracked;    ///< for each mixed cell, whether any of its faces is to be filled
    Array<std::array<std::uint32_t, triangle_level_count>>
        brick_triangles;                ///< number of triangles per brick and level
    Array<std::uint64_t> brick_counts;  ///< numbers of samples or vertices by brick, while they are numbered
    // Sets of base cells, see CellSetView.
    Array<std::uint64_t> any_inside, all_inside;               ///< signs of blocks, see SignSets
    Array<std::uint64_t> chosen;                               ///< cells that a pass chooses for the next one
    std::array<Array<std::uint64_t>, all_rules.size()> stale;  ///< stale cells by rule
    std::array<Array<std::uint64_t>, 2> asked_beside;          ///< cells that ask level 2 and 3 of their face neighbors
    SettlingTime now;                                          ///< the moment at which the band settles
    Array<RaiseTimes> raise_times;  ///< of every block where the frame is a part of one; else empty
    Array<WordHash> border_hashes;  ///< of every brick towards each of its neighbor slots, as raise_times
    AttributeNumbers attributes;    ///< numbers of the frame, set before its particles are registered
    std::uint64_t vertices_without_particles = 0;
    std::uint64_t field_evaluations = 0;
    std::uint64_t sixfold_volume = 0;  ///< six times the volume of the mesh, see steps/fill_cracks/volume.hpp

    /// Gives back the memory of samples and of all that led to them, once vertices are placed: the frame's surface
    /// cannot be emitted again.
    void release_samples();

    std::uint32_t block_count() const { return grid.members; }
    BlocksView blocks() { return blocks_view(*this, grid.view(), block_count()); }
    LevelSets level_sets() { return level_sets_of(*this, grid.view()); }
    SignSets sign_sets() { return {{grid.view(), any_inside.data()}, {grid.view(), all_inside.data()}}; }
    CellSetView stale_cells(StaleFor rule) { return {grid.view(), stale[static_cast<std::size_t>(rule)].data()}; }
    CellSetView chosen_cells() { return {grid.view(), chosen.data()}; }
};

}  // namespace meniscus::cpu
