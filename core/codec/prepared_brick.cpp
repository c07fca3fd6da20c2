// A brick's content before it is encoded, with whichever codec.
#include <string>
#include <utility>

#include "codec/coded_bits.hpp"
#include "codec/lattice/lattice_coder.hpp"
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
    charge(0);
    if (!scratch.lattice) scratch.lattice = make_lattice_coder();
    guarded([&](LatticeCoder& coder) { coder.load(mesh, brick, options); });
    charge(scratch.lattice->vertices());
}

PreparedBrick::PreparedBrick(PackedBricks& packed, std::size_t brick, const CodingOptions& options,
                             BrickScratch& scratch)
    : options_(options), scratch_(&scratch), packed_(&packed), brick_(brick) {}

void PreparedBrick::charge(std::size_t vertices) const {
    constexpr std::size_t coder_bytes = std::size_t{3} << 20;
    constexpr std::size_t bytes_a_vertex = 128;
    const std::size_t bytes = coder_bytes + bytes_a_vertex * vertices;
    Array<std::byte>& charged = scratch_->charge;
    if (charged.capacity() >= bytes) return;
    charged = Array<std::byte>(charged.get_allocator());  // gives the smaller one back first
    charged.reserve(bytes);
}

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
        charge(encoded.vertices);
        if (!scratch_->lattice) scratch_->lattice = make_lattice_coder();
        guarded([&](LatticeCoder& coder) { coder.load(encoded, options_); });
    }
    guarded([&](LatticeCoder& coder) { encoded = coder.encode(options_.codec); });
    return encoded;
}

}  // namespace meniscus
