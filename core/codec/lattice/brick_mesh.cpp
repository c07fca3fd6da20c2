#include "codec/lattice/brick_mesh.hpp"

#include <algorithm>
#include <cstddef>

#include "lattice/tables/tables.hpp"
#include "steps/emit_triangles/emit_triangles.hpp"
#include "steps/fill_cracks/fill_cracks.hpp"

namespace meniscus {
namespace {

constexpr std::ptrdiff_t most_cell_triangles =
    most_subcell_triangles * base_cell_size * base_cell_size * base_cell_size;
static_assert(most_subface_triangles <= most_cell_triangles);

Triangle* emit_cell(const BrickLattice& lattice, const BlocksView& blocks, int place, const ClosedCell& cell,
                    Triangle* out) {
    const CubeCase* const table = cube_table.data();
    switch (lattice.level[place]) {
        case 1:  // one subcell, whose case is found sooner than those of many
            return emit_subcell(table[lattice.level1_case(place)], 0, SubcellVertices{blocks, cell, 4}, out);
        case 2:
            return emit_subcell_triangles(blocks, cell, 2, VertexTable<2>(blocks, cell), table, out);
        default:
            return emit_subcell_triangles(blocks, cell, 1, VertexTable<1>(blocks, cell), table, out);
    }
}

/// visit(face, crack case) for the subfaces of a face that see both signs.
template <class Visit>
void for_each_subface(const BrickLattice& lattice, int place, int bit_of_face, const Visit& visit) {
    CrackFace face{bit_of_face >> 1, bit_of_face & 1, level_stride(lattice.level[place]), {}};
    const FaceSigns signs = lattice.face_signs(place, face.axis, face.side);
    for (BlockMask left = signs.mixed(); left != 0; left &= left - 1) {
        const int bit = lowest_bit(left);
        for (int axis = 0; axis < 3; ++axis)
            face.corner[axis] = axis == face.axis ? face.side * base_cell_size : point_coordinate(bit, axis);
        visit(face, signs.pattern(bit));
    }
}

}  // namespace

bool make_mesh(LatticeBrick& brick, const LatticePosition& origin, std::uint32_t triangles) {
    BrickLattice& lattice = brick.lattice;
    brick.positions.resize(brick.offsets.size());
    LatticePosition* position = brick.positions.data();
    const std::uint8_t* offset = brick.offsets.data();
    for (const std::uint16_t place : lattice.blocks()) {
        if (lattice.edges[place].count() == 0) continue;
        const Int3 at = closed_coordinate(place);
        const LatticePosition corner{origin[0] + (at.x * base_cell_size << brick.offset_bits),
                                     origin[1] + (at.y * base_cell_size << brick.offset_bits),
                                     origin[2] + (at.z * base_cell_size << brick.offset_bits)};
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (BlockMask left = lattice.edges[place].axis[axis]; left != 0; left &= left - 1, ++position) {
                const int bit = lowest_bit(left);
                *position = {corner[0] + (point_coordinate(bit, 0) << brick.offset_bits),
                             corner[1] + (point_coordinate(bit, 1) << brick.offset_bits),
                             corner[2] + (point_coordinate(bit, 2) << brick.offset_bits)};
                (*position)[axis] += *offset++;
            }
    }

    const BlocksView blocks = lattice.view();
    brick.triangles.resize(triangles);
    brick.levels.resize(triangles);
    Triangle* out = brick.triangles.data();
    Triangle* const end = out + triangles;
    TriangleLevel* level_out = brick.levels.data();
    const auto add = [&](const Triangle* last, TriangleLevel level) {
        level_out = std::fill_n(level_out, last - out, level);
        out += last - out;
    };
    Triangle room[most_cell_triangles];
    // Writes into `room` where there may be too little behind `out`. Returns false if it was too little.
    const auto emit = [&](std::ptrdiff_t most, TriangleLevel level, const auto& write) {
        if (end - out >= most) {
            add(write(out), level);
            return true;
        }
        const Triangle* const last = write(static_cast<Triangle*>(room));
        if (last - room > end - out) return false;
        add(std::copy(static_cast<const Triangle*>(room), last, out), level);
        return true;
    };
    for (const std::uint16_t place : lattice.cells()) {
        const ClosedCell cell = BrickLattice::closed_cell(place);
        const int level = lattice.level[place];
        bool fits = emit(most_cell_triangles, static_cast<TriangleLevel>(level - 1),
                         [&](Triangle* to) { return emit_cell(lattice, blocks, place, cell, to); });
        for (unsigned faces = lattice.coarser[place]; faces != 0; faces &= faces - 1)
            for_each_subface(lattice, place, lowest_bit(faces), [&](const CrackFace& face, int crack_case) {
                fits = fits && emit(most_subface_triangles, TriangleLevel::crack, [&](Triangle* to) {
                           return emit_crack(blocks, cell, face, crack_table[static_cast<std::size_t>(crack_case)], to);
                       });
            });
        if (!fits) return false;
    }
    return out == end;
}

}  // namespace meniscus
