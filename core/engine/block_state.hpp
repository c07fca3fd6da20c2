// The arrays of every stored base cell (block) that both engines keep, named once.
#pragma once

#include <cstdint>

#include "lattice/block_mask.hpp"
#include "lattice/blocks.hpp"
#include "lattice/cell_bend.hpp"
#include "lattice/host_device.hpp"
#include "lattice/level_sets.hpp"
#include "meniscus/memory.hpp"

namespace meniscus {

/// Bounds of the field in a cell, by its particles alone.
struct CellReach {
    float bound;    ///< no field value in the cell is above this
    float closest;  ///< largest 1 - distance/h of a particle from the cell
};

/// A<T>: an array of T in the engine's memory, Array<T> on the host and T* on a device.
template <template <class> class A>
struct BlockState {
    // An element for every block, and room for one more; BlocksView explains the members without a comment.
    A<std::uint32_t> brick;
    A<std::uint16_t> place;
    A<std::uint8_t> level;
    A<BlockMask> sampled;
    A<BlockMask> inside;
    A<BlockMask> wanted_points;  ///< points to be sampled
    A<std::uint32_t> first_sample;
    A<EdgeMasks> edges;
    A<std::uint32_t> first_vertex;
    A<std::uint32_t> particle_counts;  ///< number of particles of level 0; CountCriterion only
    A<CellReach> reaches;
    A<CellBend> bends;  ///< CurvatureCriterion only

    A<float> samples;

    // Sets of blocks, see CellSetView.
    A<std::uint64_t> base_deep;    ///< see BaseVertexSets
    A<std::uint64_t> at_least[4];  ///< see LevelSets; by level, from 1

    /// Calls visit(name, array) for all that have an element for every block.
    template <class Visit>
    void for_each_block_array(const Visit& visit) {
        visit("brick", brick);
        visit("place", place);
        visit("level", level);
        visit("sampled", sampled);
        visit("inside", inside);
        visit("wanted_points", wanted_points);
        visit("first_sample", first_sample);
        visit("edges", edges);
        visit("first_vertex", first_vertex);
        visit("particle_counts", particle_counts);
        visit("reaches", reaches);
        visit("bends", bends);
    }
    /// Calls visit(name, array) for all that have an element for every word of Brick::occupied.
    template <class Visit>
    void for_each_set(const Visit& visit) {
        visit("base_deep", base_deep);
        for (int level_index = 1; level_index <= 3; ++level_index) visit("at_least", at_least[level_index]);
    }
};

template <class T>
T* first_of(Array<T>& array) {
    return array.data();
}
template <class T>
MENISCUS_HD T* first_of(T* array) {
    return array;
}

/// grid: of the blocks; count: how many there are.
template <class State>
MENISCUS_HD BlocksView blocks_view(State& state, const BrickGridView& grid, std::uint32_t count) {
    return {grid,
            count,
            first_of(state.brick),
            first_of(state.place),
            first_of(state.level),
            first_of(state.sampled),
            first_of(state.inside),
            first_of(state.first_sample),
            first_of(state.samples),
            first_of(state.edges),
            first_of(state.first_vertex)};
}

template <class State>
MENISCUS_HD LevelSets level_sets_of(State& state, const BrickGridView& grid) {
    return {{{},
             {grid, first_of(state.at_least[1])},
             {grid, first_of(state.at_least[2])},
             {grid, first_of(state.at_least[3])}}};
}

}  // namespace meniscus
