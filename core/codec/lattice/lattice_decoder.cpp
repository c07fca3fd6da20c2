#include "codec/lattice/lattice_decoder.hpp"

#include "codec/lattice/brick_header.hpp"
#include "codec/lattice/brick_mesh.hpp"
#include "codec/lattice/packed.hpp"

namespace meniscus {

const char* LatticeDecoder::decode(std::span<const std::byte> bytes, const AnnouncedBrick& announced,
                                   const LatticePosition& origin) {
    brick_.clear();
    const auto header = BrickHeader::read(bytes);
    if (!header) return "its first bytes are not those of a lattice brick of this version";
    if (header->offset_bits != announced.offset_bits) return "has other offset bits than its mesh";
    const std::span<const std::byte> content = bytes.subspan(BrickHeader::size);
    const char* fault = header->has_entropy ? entropy_.read_geometry(*header, content, announced, brick_)
                                            : read_packed(*header, content, announced, brick_);
    if (fault != nullptr) return fault;
    if (!make_mesh(brick_, origin, announced.triangles)) return "has another number of triangles than was announced";
    return header->has_entropy ? entropy_.read_values(brick_) : nullptr;
}

}  // namespace meniscus
