#include "codec/lattice/brick_mesh.hpp"

#include <algorithm>
#include <cstddef>

#include "lattice/tables/tables.hpp"
#include "steps/emit_triangles/emit_triangles.hpp"
#include "steps/fill_cracks/fill_cracks.hpp"

namespace meniscus {
namespace {

constexpr std::ptrdiff_t most_cell_triangles = 5 * 64;
constexpr std::ptrdiff_t most_crack_triangles = 8;
static_assert(most_crack_triangles <= most_cell_triangles);

Triangle* emit_cell(const BrickLattice& lattice, const BlocksView& blocks, int place, const ClosedCell& cell,
                    Triangle* out) {
    const auto emit_subcell = [&out](int bit, int cube_case, const auto& vertex) {
        const CubeCase& pattern = cube_table[static_cast<std::size_t>(cube_case)];
        for (int t = 0; t < pattern.triangles; ++t, ++out)
            for (int corner = 0; corner < 3; ++corner)
                (*out)[static_cast<std::size_t>(corner)] =
                    vertex(bit, pattern.edges[static_cast<std::size_t>(3 * t + corner)]);
    };
    const auto emit = [&](int stride, const auto& vertex) {
        for_each_subcell(blocks, cell, stride, [&](int bit, int cube_case) { emit_subcell(bit, cube_case, vertex); });
    };
    switch (lattice.level[place]) {
        case 1:
            emit_subcell(0, lattice.level1_case(place), SubcellVertices{blocks, cell, 4});
            break;
        case 2:
            emit(2, VertexTable<2>(blocks, cell));
            break;
        default:
            emit(1, VertexTable<1>(blocks, cell));
    }
    return out;
}

/// visit(face, crack case) for the subfaces of a face that see both signs.
template <class Visit>
void for_each_subface(const BrickLattice& lattice, int place, int bit_of_face, const Visit& visit) {
    CrackFace face{bit_of_face >> 1, bit_of_face & 1, level_stride(lattice.level[place]), {}};
    const int upper = place + face.side * closed_step(face.axis);
    const int u = closed_step((face.axis + 1) % 3);
    const int v = closed_step((face.axis + 2) % 3);
    const FaceSigns signs(lattice.inside[upper], lattice.inside[upper + u], lattice.inside[upper + v],
                          lattice.inside[upper + u + v], face.axis, face.stride);
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
    /// Writes into `room` where there may be too little behind `out`. Returns false if it was too little.
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
                fits = fits && emit(most_crack_triangles, TriangleLevel::crack, [&](Triangle* to) {
                           return emit_crack(blocks, cell, face, crack_table[static_cast<std::size_t>(crack_case)], to);
                       });
            });
        if (!fits) return false;
    }
    return out == end;
}

}  // namespace meniscus
