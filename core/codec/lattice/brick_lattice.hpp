// A brick as the lattice codec has it: levels of the cells that draw, signs, vertices' edges. Its triangles follow.
//
// Encoder and decoder go through the same calls in the same order, and differ in the source of a sign. Nothing here
// allocates by what a brick claims, and nothing throws: the viewer runs it without exceptions.
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "lattice/blocks.hpp"
#include "lattice/closed_brick.hpp"
#include "lattice/face_signs.hpp"
#include "lattice/levels_around.hpp"
#include "lattice/tables/tables.hpp"
#include "steps/keep_lattice/keep_lattice.hpp"

namespace meniscus {

/// The most triangles of a cube case, and of a crack case.
inline constexpr int most_subcell_triangles = std::tuple_size_v<decltype(CubeCase::edges)> / 3;
inline constexpr int most_subface_triangles = std::tuple_size_v<decltype(CrackCase::edges)> / 3;

/// It is large, and is used again for one brick after another.
class BrickLattice {
public:
    BrickLattice();
    BrickLattice(const BrickLattice&) = delete;

    ClosedArray<std::uint8_t> level;  ///< of the brick's cells that draw, see add_cell(); 0: draws nothing of its own
    ClosedArray<std::uint8_t>
        coarser;                      ///< bit 2 axis + side: that face of a cell is to be filled against a coarser one
    ClosedArray<BlockMask> corners;   ///< points that cells of the brick have as corners
    ClosedArray<BlockMask> middles;   ///< middles of crossed coarse edges that are no corners
    ClosedArray<BlockMask> quarters;  ///< middles of the halves of those, which are neither
    ClosedArray<BlockMask> inside;    ///< signs of these points; 0 for all others
    ClosedArray<EdgeMasks> edges;     ///< finest edges that carry a vertex
    ClosedArray<std::uint32_t> first_vertex;

    /// Makes it empty.
    void clear();
    /// Adds a cell that draws; cells come in the order of their places.
    void add_cell(int place, int its_level);
    /// Finds the blocks of the cells, and in them the corners.
    void list_blocks();
    const std::vector<std::uint16_t>& cells() const { return cells_; }    ///< places, ascending
    const std::vector<std::uint16_t>& blocks() const { return blocks_; }  ///< places, ascending

    /// The levels of the brick's cells that share the points of a block.
    LevelsAround around(int place) const {
        LevelsAround levels;
        for (int at_least = 1; at_least <= 3; ++at_least)
            levels.at_least[at_least] = static_cast<int>(around_[place] >> (8 * at_least) & 0xFF);
        return levels;
    }

    /// The cube case of a cell of level 1, which is one subcell.
    int level1_case(int place) const {
        int signs = 0;
        for (int i = 0; i < 8; ++i) signs |= static_cast<int>(inside[place + closed_steps(i)] & 1) << i;
        return signs;
    }
    /// Whether every cell sees both signs, and levels of cells that share a face differ by at most one.
    bool is_drawable() const;
    /// The level of all cells; 0 if they differ. There is a cell.
    int only_level() const;
    /// The signs on a face of a cell, seen at its own stride. side: 0 below, 1 above.
    FaceSigns face_signs(int place, int axis, int side) const;
    /// Fills `coarser` for faces within the brick.
    void find_coarser_faces();
    /// Calls visit(place, bit of `coarser`) for the faces of cells on the brick's own faces that see both signs, and
    /// may lie against a coarser cell beyond. By cell, then by bit.
    template <class Visit>
    void for_each_outer_face(const Visit& visit) const {
        for (const std::uint16_t place : cells_) {
            if (level[place] < 2) continue;
            const Int3 at = closed_coordinate(place);
            const int coordinate[3] = {at.x, at.y, at.z};
            for (int bit = 0; bit < 6; ++bit)
                if (coordinate[bit >> 1] == (bit & 1) * (brick_size - 1) &&
                    face_signs(place, bit >> 1, bit & 1).mixed() != 0)
                    visit(int{place}, bit);
        }
    }
    /// Finds a block's finest edges that carry a vertex, once the signs of all corners are there. middle(points): the
    /// signs of these points, middles of crossed coarse edges that are no corners.
    template <class Middle>
    void find_edges(int place, const Middle& middle) {
        BlockMask next[3];
        for (int axis = 0; axis < 3; ++axis) next[axis] = inside[place + closed_step(axis)];
        find_brick_edges(around(place), corners[place], next, middle,
                         {inside[place], middles[place], quarters[place], edges[place]});
    }

    /// Numbers the vertices by block, axis and bit, and returns how many there are.
    std::uint32_t number_vertices();
    /// The most triangles that cells of these levels can have.
    std::uint32_t most_triangles() const;
    /// The blocks for the rules of the steps: their numbers are places.
    BlocksView view();
    static ClosedCell closed_cell(int place) {
        ClosedCell cell;
        for (int i = 0; i < 8; ++i) cell.block[i] = static_cast<std::uint32_t>(place + closed_steps(i));
        return cell;
    }

private:
    ClosedArray<std::uint32_t> around_;  ///< byte l: the cells of level l or more, as LevelsAround has them
    std::vector<std::uint16_t> cells_;
    std::vector<std::uint16_t> blocks_;
};

}  // namespace meniscus
