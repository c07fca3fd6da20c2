#include "codec/lattice/lattice_coder.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "codec/attribute_values.hpp"
#include "codec/coded_bits.hpp"
#include "codec/content_hash.hpp"
#include "codec/lattice/brick_header.hpp"
#include "codec/lattice/brick_mesh.hpp"
#include "codec/lattice/entropy.hpp"
#include "codec/lattice/lattice_decoder.hpp"
#include "codec/lattice/octahedron.hpp"
#include "codec/lattice/packed.hpp"
#include "codec/round_position.hpp"
#include "meniscus/error.hpp"

namespace meniscus {
namespace {

class Coder final : public LatticeCoder {
public:
    void load(const Mesh& mesh, std::size_t number, const CodingOptions& options) override {
        const MeshBrick& mesh_brick = mesh.bricks.at(number);
        const LatticeRange range = mesh.lattice.bricks.at(number);
        const std::span<const LatticeBlock> blocks(mesh.lattice.blocks.data() + range.first, range.count);
        brick_.clear();
        coordinate_ = mesh_brick.coordinate;
        triangles_ = mesh_brick.triangle_count();
        options_ = &options;
        brick_.offset_bits = static_cast<int>(encoded_offset_bits(mesh, options));
        brick_.normal_bits = mesh.normals.empty() ? 0 : options.normal_bits;
        take_lattice(blocks);
        take_vertices(mesh, blocks);
        for (const CodedAttribute& form : options.attributes)
            brick_.attributes.push_back(coded_values(attribute_of(mesh, form), form, vertices_));
    }

    void load(const EncodedBrick& packed, const CodingOptions& options) override {
        brick_.clear();
        coordinate_ = packed.coordinate;
        triangles_ = packed.triangles;
        options_ = &options;
        const auto header = BrickHeader::read(packed.data);
        if (!header || header->has_entropy) throw InvalidInput("the brick is not packed");
        const std::vector<std::size_t> attribute_bytes = coded_bytes(options.attributes);
        const char* const fault = read_packed(*header, std::span(packed.data).subspan(BrickHeader::size),
                                              {.vertices = packed.vertices,
                                               .triangles = packed.triangles,
                                               .offset_bits = header->offset_bits,
                                               .attribute_bytes = attribute_bytes},
                                              brick_);
        if (fault != nullptr) throw InvalidInput(std::string("the packed brick ") + fault);
    }

    std::size_t vertices() const override { return brick_.offsets.size(); }

    ContentHash hash() const override {
        ContentHasher hasher;
        const std::array<int, 2> bits{brick_.offset_bits, brick_.normal_bits};
        hasher.add(bits.data(), bits.size());
        const BrickLattice& lattice = brick_.lattice;
        hasher.add(lattice.cells().data(), lattice.cells().size());
        // A brick's blocks follow from its cells, and its edges from levels and signs.
        hashed_.clear();
        for (const std::uint16_t place : lattice.blocks()) {
            hashed_.push_back(lattice.inside[place]);
            hashed_.push_back(std::uint64_t{lattice.level[place]} | std::uint64_t{lattice.coarser[place]} << 8);
        }
        hasher.add(hashed_.data(), hashed_.size());
        hasher.add(brick_.offsets.data(), brick_.offsets.size());
        hasher.add(brick_.normals.data(), brick_.normals.size());
        hasher.add(options_->attributes);
        for (const std::vector<std::byte>& values : brick_.attributes) hasher.add(values.data(), values.size());
        return hasher.hash();
    }

    EncodedBrick encode(Codec codec) override { return write(brick_, coordinate_, triangles_, codec); }

    DecodedBrick decode(const EncodedBrick& encoded, const LatticePosition& origin, std::uint32_t offset_bits,
                        std::span<const CodedAttribute> attributes) override {
        DecodedBrick decoded = mesh_of(read(encoded, origin, offset_bits, attributes), encoded.coordinate);
        for (std::size_t a = 0; a < attributes.size(); ++a)
            decoded.attributes.push_back(decoded_values(attributes[a], decoder_->brick().attributes[a]));
        return decoded;
    }

    EncodedBrick recode(const EncodedBrick& encoded, std::uint32_t offset_bits,
                        std::span<const CodedAttribute> attributes, const CodingOptions& options) override {
        LatticeBrick& brick = read(encoded, {}, offset_bits, attributes);
        if (encoded.codec == Codec::lattice_entropy) find_middles(brick.lattice);
        round_normals(brick, options.normal_bits);
        round_offsets(brick, options.position_bits);
        recode_attributes(brick, attributes, options.attributes);
        if (options.codec != Codec::draco) return write(brick, encoded.coordinate, encoded.triangles, options.codec);
        LatticePosition origin;
        for (std::size_t axis = 0; axis < 3; ++axis)
            origin[axis] = encoded.coordinate[axis] * (brick_cells << brick.offset_bits);
        make_mesh(brick, origin, encoded.triangles);
        DecodedBrick decoded = mesh_of(brick, encoded.coordinate);
        for (std::size_t a = 0; a < options.attributes.size(); ++a)
            decoded.attributes.push_back(decoded_values(options.attributes[a], brick.attributes[a]));
        return encode_brick(decoded, static_cast<std::uint32_t>(brick.offset_bits), options);
    }

private:
    /// The brick with its mesh. Throws InvalidInput for bytes that are none.
    LatticeBrick& read(const EncodedBrick& encoded, const LatticePosition& origin, std::uint32_t offset_bits,
                       std::span<const CodedAttribute> attributes) {
        const std::vector<std::size_t> attribute_bytes = coded_bytes(attributes);
        const auto header = BrickHeader::read(encoded.data);
        if (header && header->has_entropy != (encoded.codec == Codec::lattice_entropy))
            throw InvalidInput("has the bytes of another codec than it names");
        if (!encoded.cell_levels.empty()) throw InvalidInput("has cell levels, which its codec does without");
        if (!decoder_) decoder_ = std::make_unique<LatticeDecoder>();
        const char* const fault = decoder_->decode(encoded.data,
                                                   {.vertices = encoded.vertices,
                                                    .triangles = encoded.triangles,
                                                    .offset_bits = static_cast<int>(offset_bits),
                                                    .attribute_bytes = attribute_bytes},
                                                   origin);
        if (fault != nullptr) throw InvalidInput(fault);
        LatticeBrick& brick = decoder_->brick();
        if (brick.normal_bits == 0) return brick;
        const Octahedron octahedron(brick.normal_bits);
        for (const std::uint32_t code : brick.normals)
            if (!octahedron.holds(code)) throw InvalidInput("has a normal that is none");
        return brick;
    }
    /// Takes the mesh of a brick that was read, without attributes.
    static DecodedBrick mesh_of(LatticeBrick& brick, const std::array<std::int32_t, 3>& coordinate) {
        DecodedBrick mesh;
        mesh.coordinate = coordinate;
        mesh.vertices = std::move(brick.positions);
        mesh.triangles = std::move(brick.triangles);
        mesh.levels = std::move(brick.levels);
        if (brick.normal_bits == 0) return mesh;
        const Octahedron octahedron(brick.normal_bits);
        mesh.normals.reserve(brick.normals.size());
        for (const std::uint32_t code : brick.normals) mesh.normals.push_back(octahedron.vector(code));
        return mesh;
    }
    /// Of bricks of the entropy profile the edges are known, and the signs of their middles: not which points these
    /// are, which the packed profile asks.
    static void find_middles(BrickLattice& lattice) {
        std::vector<BlockMask> known;
        for (const std::uint16_t place : lattice.blocks()) {
            known.push_back(lattice.inside[place]);
            lattice.inside[place] &= lattice.corners[place];
            lattice.edges[place] = {};
        }
        for (std::size_t i = 0; i < known.size(); ++i)
            lattice.find_edges(lattice.blocks()[i], [&](BlockMask middles) { return known[i] & middles; });
    }
    static void round_normals(LatticeBrick& brick, int bits) {
        if (brick.normal_bits == 0 || bits == brick.normal_bits) return;
        check_normal_bits(bits);
        if (bits == 0) {
            brick.normals.clear();
        } else {
            const Octahedron from(brick.normal_bits);
            const Octahedron to(bits);
            for (std::uint32_t& code : brick.normals) code = to.code(to.point(from.vector(code)));
        }
        brick.normal_bits = bits;
    }
    /// bits: 0 for those that it has.
    static void round_offsets(LatticeBrick& brick, int bits) {
        if (bits == 0 || bits == brick.offset_bits) return;
        if (bits < static_cast<int>(min_offset_bits) || bits > brick.offset_bits)
            throw InvalidInput("is to be encoded with " + std::to_string(bits) + " position bits, must be " +
                               std::to_string(min_offset_bits) + " to its " + std::to_string(brick.offset_bits));
        for (std::uint8_t& offset : brick.offsets)
            offset = static_cast<std::uint8_t>(round_position(offset, static_cast<std::uint32_t>(brick.offset_bits),
                                                              static_cast<std::uint32_t>(bits)));
        brick.offset_bits = bits;
    }
    /// from: the attributes that the brick has; to: some of them, in forms of their own.
    static void recode_attributes(LatticeBrick& brick, std::span<const CodedAttribute> from,
                                  std::span<const CodedAttribute> to) {
        std::vector<std::uint32_t> all(brick.offsets.size());
        std::iota(all.begin(), all.end(), 0U);
        std::vector<std::vector<std::byte>> recoded;
        for (const CodedAttribute& form : to) {
            const auto found = std::ranges::find(from, form.name, &CodedAttribute::name);
            if (found == from.end()) throw InvalidInput("has no attribute '" + form.name + "'");
            std::vector<std::byte>& coded = brick.attributes[static_cast<std::size_t>(found - from.begin())];
            recoded.push_back(*found == form ? std::move(coded)
                                             : coded_values(decoded_values(*found, coded), form, all));
        }
        brick.attributes = std::move(recoded);
    }
    EncodedBrick write(LatticeBrick& brick, const std::array<std::int32_t, 3>& coordinate, std::uint32_t triangles,
                       Codec codec) {
        EncodedBrick encoded;
        encoded.coordinate = coordinate;
        encoded.codec = codec;
        encoded.vertices = static_cast<std::uint32_t>(brick.offsets.size());
        encoded.triangles = triangles;
        if (codec == Codec::lattice_packed) {
            write_packed(brick, bits_, encoded.data);
        } else {
            if (brick.normal_bits != 0) make_mesh(brick, {}, triangles);
            entropy_.write(brick, encoded.data);
        }
        return encoded;
    }
    static std::vector<std::size_t> coded_bytes(std::span<const CodedAttribute> attributes) {
        std::vector<std::size_t> bytes;
        for (const CodedAttribute& form : attributes) bytes.push_back(form.coded_bytes());
        return bytes;
    }
    void take_lattice(std::span<const LatticeBlock> blocks) {
        BrickLattice& lattice = brick_.lattice;
        for (const LatticeBlock& block : blocks)
            if (block.level != 0) lattice.add_cell(block.place, block.level);
        lattice.list_blocks();
        for (const LatticeBlock& block : blocks) {
            lattice.inside[block.place] = block.inside & lattice.corners[block.place];
            outer_[block.place] = block.coarser;
        }
        // Beyond a face that shows one sign alone nothing is to be filled, whatever the level there.
        lattice.for_each_outer_face([&](int place, int bit) {
            lattice.coarser[place] = static_cast<std::uint8_t>(lattice.coarser[place] | (outer_[place] & 1 << bit));
        });
        lattice.find_coarser_faces();
    }
    void take_vertices(const Mesh& mesh, std::span<const LatticeBlock> blocks) {
        BrickLattice& lattice = brick_.lattice;
        vertices_.clear();
        for (const LatticeBlock& block : blocks) {
            lattice.find_edges(block.place, [&](BlockMask middles) { return block.inside & middles; });
            lattice.first_vertex[block.place] = static_cast<std::uint32_t>(vertices_.size());
            for_each_brick_vertex(
                block.edges, block.first_vertex, lattice.edges[block.place], [&](int axis, std::uint32_t vertex) {
                    vertices_.push_back(vertex);
                    brick_.offsets.push_back(edge_offset(mesh.vertices[vertex][static_cast<std::size_t>(axis)],
                                                         mesh.offset_bits, brick_.offset_bits));
                });
        }
        if (brick_.normal_bits == 0) return;
        const Octahedron octahedron(brick_.normal_bits);
        for (const std::uint32_t vertex : vertices_)
            brick_.normals.push_back(octahedron.code(octahedron.point(mesh.normals[vertex])));
    }

    LatticeBrick brick_;
    std::array<std::int32_t, 3> coordinate_{};
    std::uint32_t triangles_ = 0;
    ClosedArray<std::uint8_t> outer_;            ///< LatticeBlock::coarser of the brick's blocks
    std::vector<std::uint32_t> vertices_;        ///< numbers in the mesh
    mutable std::vector<std::uint64_t> hashed_;  ///< memory of hash()
    const CodingOptions* options_ = nullptr;     ///< of the brick loaded last
    BitWriter bits_;
    EntropyWriter entropy_;
    std::unique_ptr<LatticeDecoder> decoder_;  ///< made for the first brick that is decoded
};

}  // namespace

template <>
std::unique_ptr<LatticeCoder> make_lattice_coder<InstructionSet::MENISCUS_INSTRUCTION_SET>() {
    return std::make_unique<Coder>();
}

}  // namespace meniscus
