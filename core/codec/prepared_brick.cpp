// A brick's content before it is encoded, with whichever codec.
#include <string>
#include <utility>

#include "codec/lattice/lattice_coder.hpp"
#include "codec/normal_rounding.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/error.hpp"

namespace meniscus {

BrickScratch::BrickScratch(std::shared_ptr<MemoryAccount> account)
    : slots(AccountAllocator<std::uint32_t>(account)), charge(AccountAllocator<std::byte>(std::move(account))) {}
BrickScratch::~BrickScratch() = default;
BrickScratch::BrickScratch(BrickScratch&&) noexcept = default;

PreparedBrick::PreparedBrick(const Mesh& mesh, std::size_t brick, const CodingOptions& options, BrickScratch& scratch)
    : options_(options) {
    if (options.codec != Codec::lattice_packed && options.codec != Codec::lattice_entropy) {
        content_ = brick_content(mesh, brick, options, scratch);
        return;
    }
    if (mesh.lattice.bricks.size() != mesh.bricks.size())
        throw InvalidInput("codec is " + std::string(name_of(options.codec)) +
                           ", but the mesh has no lattice: reconstruct it on the CPU with keep_lattice, or use Draco");
    check_normal_bits(options.normal_bits);
    if (!scratch.lattice) {
        constexpr std::size_t coder_bytes = std::size_t{3} << 20;
        scratch.charge.reserve(coder_bytes);
        scratch.lattice = make_lattice_coder();
    }
    lattice_ = scratch.lattice.get();
    lattice_->load(mesh, brick, options);
}

ContentHash PreparedBrick::hash() const {
    return lattice_ != nullptr ? lattice_->hash() : content_.hash();
}

EncodedBrick PreparedBrick::encode() const {
    return lattice_ != nullptr ? lattice_->encode(options_.codec) : encode_brick(content_, options_);
}

}  // namespace meniscus
