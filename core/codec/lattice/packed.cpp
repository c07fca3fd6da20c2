#include "codec/lattice/packed.hpp"

#include "codec/lattice/brick_mesh.hpp"
#include "codec/lattice/packed_fields.hpp"

namespace meniscus {
namespace {

void write_cells(const BrickLattice& lattice, int only_level, BitWriter& bits) {
    std::uint64_t rows[brick_size][brick_size] = {};
    std::uint64_t slices[brick_size] = {};
    for (const std::uint16_t place : lattice.cells()) {
        const Int3 at = closed_coordinate(place);
        rows[at.z][at.y] |= std::uint64_t{1} << at.x;
        slices[at.z] |= std::uint64_t{1} << at.y;
    }
    bits.reserve(brick_size * brick_size * (brick_size + 1) + level_bits * lattice.cells().size());
    for (int z = 0; z < brick_size; ++z) {
        bits.put(slices[z], brick_size);
        for (std::uint64_t left = slices[z]; left != 0; left &= left - 1)
            bits.put(rows[z][lowest_bit(left)], brick_size);
    }
    if (only_level != 0)
        bits.put(static_cast<unsigned>(only_level) - 1, level_bits);
    else
        for (const std::uint16_t place : lattice.cells()) bits.put(lattice.level[place] - 1U, level_bits);
}

const char* read_cells(bool one_level, BitReader& bits, BrickLattice& lattice) {
    std::uint16_t places[brick_volume];
    int count = 0;
    for (int z = 0; z < brick_size; ++z)
        for (std::uint64_t slice = bits.get_some(brick_size); slice != 0; slice &= slice - 1) {
            const int y = lowest_bit(slice);
            for (std::uint64_t row = bits.get_some(brick_size); row != 0; row &= row - 1)
                places[count++] = static_cast<std::uint16_t>(closed_place(lowest_bit(row), y, z));
        }
    if (count == 0) return "has no cell that draws";
    std::uint64_t level = 0;
    for (int i = 0; i < count; ++i) {
        if (i == 0 || !one_level) level = bits.get_some(level_bits) + 1;
        if (level > 3) return "has a cell of a level that this version does not know";
        lattice.add_cell(places[i], static_cast<int>(level));
    }
    lattice.list_blocks();
    return bits.is_good() ? nullptr : "ends within its cells";
}

}  // namespace

void write_packed(const LatticeBrick& brick, BitWriter& bits, std::vector<std::byte>& out) {
    const BrickLattice& lattice = brick.lattice;
    const int only_level = lattice.only_level();
    const BrickHeader header{
        .has_one_level = only_level != 0, .offset_bits = brick.offset_bits, .normal_bits = brick.normal_bits};
    for (const std::byte byte : header.bytes()) out.push_back(byte);

    bits.clear();
    write_cells(lattice, only_level, bits);
    bits.reserve(64 * lattice.blocks().size());
    for (const std::uint16_t place : lattice.blocks()) put_signs(lattice.inside[place], lattice.corners[place], bits);
    bits.reserve(6 * lattice.cells().size());
    lattice.for_each_outer_face([&](int place, int bit) { bits.put(lattice.coarser[place] >> bit & 1, 1); });
    const std::uint8_t* offset = brick.offsets.data();
    bits.reserve(64 * lattice.blocks().size() + static_cast<std::size_t>(brick.offset_bits) * brick.offsets.size());
    for (const std::uint16_t place : lattice.blocks()) {
        for (const BlockMask points : {lattice.middles[place], lattice.quarters[place]})
            put_signs(lattice.inside[place], points, bits);
        for (int left = lattice.edges[place].count(); left > 0; --left) bits.put(*offset++, brick.offset_bits);
    }
    bits.reserve(static_cast<std::size_t>(2 * brick.normal_bits) * brick.normals.size());
    for (const std::uint32_t normal : brick.normals)
        bits.put(normal_field(normal, brick.normal_bits), 2 * brick.normal_bits);
    bits.append_to(out);
    for (const std::vector<std::byte>& values : brick.attributes) out.insert(out.end(), values.begin(), values.end());
}

const char* read_packed(const BrickHeader& header, std::span<const std::byte> bytes, const AnnouncedBrick& announced,
                        LatticeBrick& brick) {
    BitReader bits(bytes);
    BrickLattice& lattice = brick.lattice;
    brick.offset_bits = header.offset_bits;
    brick.normal_bits = header.normal_bits;
    if (const char* fault = read_cells(header.has_one_level, bits, lattice)) return fault;
    for (const std::uint16_t place : lattice.blocks()) {
        const BlockMask corners = lattice.corners[place];
        lattice.inside[place] =
            corners == ~BlockMask{0} ? bits.get(64) : scatter_bits(bits.get(popcount(corners)), corners);
    }
    if (!bits.is_good()) return "ends within its signs";
    if (!lattice.is_drawable()) return "has a cell that draws nothing, or levels that jump";
    lattice.find_coarser_faces();
    lattice.for_each_outer_face([&](int place, int bit) {
        lattice.coarser[place] = static_cast<std::uint8_t>(lattice.coarser[place] | bits.get_some(1) << bit);
    });
    if (announced.triangles > lattice.most_triangles()) return "announces more triangles than its cells have";
    if (announced.vertices > bits.bits_left() / static_cast<unsigned>(header.offset_bits))
        return "announces more vertices than its bytes have";
    brick.offsets.resize(announced.vertices);
    std::uint32_t count = 0;
    for (const std::uint16_t place : lattice.blocks()) {
        lattice.find_edges(place,
                           [&](BlockMask middles) { return scatter_bits(bits.get(popcount(middles)), middles); });
        const auto own = static_cast<std::uint32_t>(lattice.edges[place].count());
        if (own > announced.vertices - count) return "has more vertices than were announced";
        lattice.first_vertex[place] = count;
        for (const std::uint32_t end = count + own; count < end; ++count) {
            brick.offsets[count] = static_cast<std::uint8_t>(bits.get_some(header.offset_bits));
            if (brick.offsets[count] == 0) return "has a vertex at the end of its edge";
        }
    }
    if (count != announced.vertices) return "has fewer vertices than were announced";
    if (header.normal_bits != 0) {
        if (announced.vertices > bits.bits_left() / static_cast<unsigned>(2 * header.normal_bits))
            return "ends within its normals";
        brick.normals.resize(announced.vertices);
        for (std::uint32_t& normal : brick.normals) {
            const auto low = static_cast<std::uint32_t>(bits.get_some(header.normal_bits));
            normal = low | static_cast<std::uint32_t>(bits.get_some(header.normal_bits)) << 16;
        }
    }
    if (!bits.is_good()) return "ends within its vertices";
    return read_attributes(bits.rest(), announced, brick);
}

}  // namespace meniscus
