#include "codec/lattice/brick_lattice.hpp"

#include <algorithm>

#include "lattice/tables/tables.hpp"
#include "steps/count_triangles/count_triangles.hpp"

namespace meniscus {

BrickLattice::BrickLattice() {
    cells_.reserve(brick_volume);
    blocks_.reserve(closed_places);
}

void BrickLattice::clear() {
    for (const std::uint16_t place : cells_) {  // of which a refused brick may have listed no blocks
        level[place] = coarser[place] = 0;
        for (int i = 0; i < 8; ++i) around_[place + closed_steps(i)] = 0;
    }
    for (const std::uint16_t place : blocks_) {
        corners[place] = middles[place] = quarters[place] = inside[place] = 0;
        edges[place] = {};
    }
    cells_.clear();
    blocks_.clear();
}

void BrickLattice::add_cell(int place, int its_level) {
    static constexpr std::uint32_t bytes_of_level[] = {0, 0x100, 0x10100, 0x1010100};
    level[place] = static_cast<std::uint8_t>(its_level);
    cells_.push_back(static_cast<std::uint16_t>(place));
    for (int i = 0; i < 8; ++i) around_[place + closed_steps(i)] |= bytes_of_level[its_level] << i;
}

void BrickLattice::list_blocks() {
    ClosedPlaces listed;
    for (const std::uint16_t cell : cells_) listed.add_cell(cell);
    listed.for_each([this](int place) {
        blocks_.push_back(static_cast<std::uint16_t>(place));
        corners[place] = corner_points(around(place));
    });
}

int BrickLattice::only_level() const {
    const int first = level[cells_[0]];
    for (const std::uint16_t place : cells_)
        if (level[place] != first) return 0;
    return first;
}

bool BrickLattice::is_drawable() const {
    for (const std::uint16_t place : cells_) {
        if (level[place] == 1) {
            const int cube_case = level1_case(place);
            if (cube_case == 0 || cube_case == cube_case_count - 1) return false;
        } else {
            BlockMask signs[8];
            for (int i = 0; i < 8; ++i) signs[i] = inside[place + closed_steps(i)];
            const int stride = level_stride(level[place]);
            if (SubcellCorners(signs, stride).mixed(stride) == 0) return false;
        }
        for (int axis = 0; axis < 3; ++axis) {
            const int above = level[place + closed_step(axis)];
            if (above != 0 && std::abs(above - level[place]) > 1) return false;
        }
    }
    return true;
}

void BrickLattice::find_coarser_faces() {
    for (const std::uint16_t place : cells_) {
        if (level[place] < 2) continue;
        const Int3 at = closed_coordinate(place);
        const int coordinate[3] = {at.x, at.y, at.z};
        for (int bit = 0; bit < 6; ++bit) {
            const int axis = bit >> 1;
            const int side = bit & 1;
            if (coordinate[axis] == side * (brick_size - 1)) continue;
            const int other = place + (2 * side - 1) * closed_step(axis);
            // A neighbor that draws nothing is a coarser one: of the cell's own level it would see both signs, too.
            if (level[other] < level[place] && face_signs(place, axis, side).mixed() != 0)
                coarser[place] = static_cast<std::uint8_t>(coarser[place] | 1 << bit);
        }
    }
}

FaceSigns BrickLattice::face_signs(int place, int axis, int side) const {
    const int upper = place + side * closed_step(axis);
    const int u = closed_step((axis + 1) % 3);
    const int v = closed_step((axis + 2) % 3);
    return {inside[upper], inside[upper + u],         inside[upper + v], inside[upper + u + v],
            axis,          level_stride(level[place])};
}

std::uint32_t BrickLattice::number_vertices() {
    std::uint32_t number = 0;
    for (const std::uint16_t place : blocks_) {
        first_vertex[place] = number;
        number += static_cast<std::uint32_t>(edges[place].count());
    }
    return number;
}

std::uint32_t BrickLattice::most_triangles() const {
    std::uint32_t most = 0;
    for (const std::uint16_t place : cells_) {
        const auto subcells_a_side = static_cast<std::uint32_t>(base_cell_size / level_stride(level[place]));
        most += most_subcell_triangles * subcells_a_side * subcells_a_side * subcells_a_side;
        most += static_cast<std::uint32_t>(popcount(coarser[place])) * most_subface_triangles * (subcells_a_side / 2) *
                (subcells_a_side / 2);
    }
    return most;
}

BlocksView BrickLattice::view() {
    BlocksView blocks;
    blocks.count = closed_places;
    blocks.level = level.data();
    blocks.inside = inside.data();
    blocks.edges = edges.data();
    blocks.first_vertex = first_vertex.data();
    return blocks;
}

}  // namespace meniscus
