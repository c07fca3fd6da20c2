#include "codec/lattice/lattice_coder.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "codec/attribute_values.hpp"
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

    EncodedBrick encode(Codec codec) override {
        EncodedBrick encoded;
        encoded.coordinate = coordinate_;
        encoded.codec = codec;
        encoded.vertices = static_cast<std::uint32_t>(brick_.offsets.size());
        encoded.triangles = triangles_;
        if (codec == Codec::lattice_packed) {
            write_packed(brick_, bits_, encoded.data);
        } else {
            if (brick_.normal_bits != 0) make_mesh(brick_, {}, triangles_);
            entropy_.write(brick_, encoded.data);
        }
        return encoded;
    }

    DecodedBrick decode(const EncodedBrick& encoded, const LatticePosition& origin, std::uint32_t offset_bits,
                        std::span<const CodedAttribute> attributes) override {
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
        DecodedBrick decoded;
        decoded.coordinate = encoded.coordinate;
        decoded.vertices = std::move(brick.positions);
        decoded.triangles = std::move(brick.triangles);
        decoded.levels = std::move(brick.levels);
        if (brick.normal_bits != 0) {
            const Octahedron octahedron(brick.normal_bits);
            decoded.normals.reserve(brick.normals.size());
            for (const std::uint32_t code : brick.normals) {
                if (!octahedron.holds(code)) throw InvalidInput("has a normal that is none");
                decoded.normals.push_back(octahedron.vector(code));
            }
        }
        for (std::size_t a = 0; a < attributes.size(); ++a)
            decoded.attributes.push_back(decoded_values(attributes[a], brick.attributes[a]));
        return decoded;
    }

private:
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
                    brick_.offsets.push_back(
                        edge_offset(mesh.vertices[vertex], axis, mesh.offset_bits, brick_.offset_bits));
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
