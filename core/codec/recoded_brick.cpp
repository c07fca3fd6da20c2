// Lattice bricks that were encoded elsewhere, in scratch memory.
#include "codec/brick_refusal.hpp"
#include "codec/content_hash.hpp"
#include "codec/lattice/brick_header.hpp"
#include "codec/lattice/lattice_coder.hpp"
#include "codec/scratch_charge.hpp"
#include "meniscus/brick_recoding.hpp"
#include "meniscus/error.hpp"

namespace meniscus {
namespace {

/// Calls work(coder) with the scratch memory's coder, which has memory for the brick. Names the brick in refusals.
template <class Work>
auto with_coder(const EncodedBrick& brick, BrickScratch& scratch, const Work& work) {
    if (!needs_lattice(brick.codec))
        refuse(brick, "its codec is " + std::string(name_of(brick.codec)) + ", which has no lattice");
    if (brick.vertices > max_brick_triangles)
        refuse(brick, "has " + std::to_string(brick.vertices) + " vertices; a brick has at most " +
                          std::to_string(max_brick_triangles));
    charge_for(brick.vertices, scratch);
    if (!scratch.lattice) scratch.lattice = make_lattice_coder();
    try {
        return work(*scratch.lattice);
    } catch (const InvalidInput& fault) {
        refuse(brick, fault.what());
    }
}

}  // namespace

DecodedBrick decode_brick(const EncodedBrick& brick, std::uint32_t offset_bits,
                          std::span<const CodedAttribute> attributes, BrickScratch& scratch) {
    const LatticePosition origin = brick_origin(brick, offset_bits);
    return with_coder(brick, scratch,
                      [&](LatticeCoder& coder) { return coder.decode(brick, origin, offset_bits, attributes); });
}

int normal_bits_of(const EncodedBrick& brick) {
    const auto header = BrickHeader::read(brick.data);
    if (!header) refuse(brick, "its first bytes are not those of a lattice brick of this version");
    return header->normal_bits;
}

EncodedBrick recode_brick(const EncodedBrick& brick, std::uint32_t offset_bits,
                          std::span<const CodedAttribute> attributes, const CodingOptions& options,
                          BrickScratch& scratch) {
    return with_coder(brick, scratch,
                      [&](LatticeCoder& coder) { return coder.recode(brick, offset_bits, attributes, options); });
}

ContentHash content_hash(const EncodedBrick& brick, const std::vector<CodedAttribute>& attributes) {
    ContentHasher hasher;
    const std::array<std::uint32_t, 3> numbers{brick.vertices, brick.triangles,
                                               static_cast<std::uint32_t>(brick.codec)};
    hasher.add(numbers.data(), numbers.size());
    hasher.add(brick.cell_levels.data(), brick.cell_levels.size());
    hasher.add(brick.data.data(), brick.data.size());
    hasher.add(attributes);
    return hasher.hash();
}

}  // namespace meniscus
