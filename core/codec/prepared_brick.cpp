// A brick's content before it is encoded, with whichever codec.
#include <string>
#include <utility>

#include "codec/coded_bits.hpp"
#include "codec/lattice/lattice_coder.hpp"
#include "codec/scratch_charge.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/error.hpp"
#include "meniscus/packed_bricks.hpp"

namespace meniscus {

BrickScratch::BrickScratch(std::shared_ptr<MemoryAccount> account)
    : slots(AccountAllocator<std::uint32_t>(account)), charge(AccountAllocator<std::byte>(std::move(account))) {}
BrickScratch::~BrickScratch() = default;
BrickScratch::BrickScratch(BrickScratch&&) noexcept = default;

PreparedBrick::PreparedBrick(const Mesh& mesh, std::size_t brick, const CodingOptions& options, BrickScratch& scratch)
    : options_(options) {
    if (!needs_lattice(options.codec)) {
        content_ = brick_content(mesh, brick, options, scratch);
        return;
    }
    if (mesh.lattice.bricks.size() != mesh.bricks.size())
        throw InvalidInput("codec is " + std::string(name_of(options.codec)) +
                           ", but the mesh has no lattice: reconstruct it with keep_lattice, or use Draco");
    check_normal_bits(options.normal_bits);
    scratch_ = &scratch;
    charge_for(0, scratch);
    if (!scratch.lattice) scratch.lattice = make_lattice_coder();
    guarded([&](LatticeCoder& coder) { coder.load(mesh, brick, options); });
    charge_for(scratch.lattice->vertices(), scratch);
}

PreparedBrick::PreparedBrick(PackedBricks& packed, std::size_t brick, const CodingOptions& options,
                             BrickScratch& scratch)
    : options_(options), scratch_(&scratch), packed_(&packed), brick_(brick) {}

template <class Work>
void PreparedBrick::guarded(const Work& work) const {
    try {
        work(*scratch_->lattice);
    } catch (...) {
        scratch_->lattice.reset();  // what it left behind would show in the next brick
        throw;
    }
}

ContentHash PreparedBrick::hash() const {
    if (packed_ != nullptr) return packed_->hash(brick_);
    return scratch_ != nullptr ? scratch_->lattice->hash() : content_.hash();
}

EncodedBrick PreparedBrick::encode() const {
    if (scratch_ == nullptr) return encode_brick(content_, options_);
    EncodedBrick encoded;
    if (packed_ != nullptr) {
        encoded = packed_->bring(brick_);
        if (options_.codec == encoded.codec) return encoded;
        charge_for(encoded.vertices, *scratch_);
        if (!scratch_->lattice) scratch_->lattice = make_lattice_coder();
        guarded([&](LatticeCoder& coder) { coder.load(encoded, options_); });
    }
    guarded([&](LatticeCoder& coder) { encoded = coder.encode(options_.codec); });
    return encoded;
}

}  // namespace meniscus
