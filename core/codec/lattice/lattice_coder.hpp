// Lattice bricks of a mesh to bytes and back, compiled for every instruction set.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "base/instruction_set.hpp"
#include "meniscus/brick_coding.hpp"

namespace meniscus {

/// One brick at a time; what it works in, some 2 MB, is kept from brick to brick.
class LatticeCoder {
public:
    virtual ~LatticeCoder() = default;
    /// Takes a brick's content out of a mesh that has its lattice. Options as for encode_brick(); they stay until
    /// hash().
    virtual void load(const Mesh& mesh, std::size_t brick, const CodingOptions& options) = 0;
    /// The same out of a packed brick. Throws InvalidInput for bytes that are none.
    virtual void load(const EncodedBrick& packed, const CodingOptions& options) = 0;
    /// Vertices of the content loaded last.
    virtual std::size_t vertices() const = 0;
    /// Of that content.
    virtual ContentHash hash() const = 0;
    /// Encodes it. codec: lattice_packed or lattice_entropy.
    virtual EncodedBrick encode(Codec codec) = 0;
    /// See decode_brick().
    virtual DecodedBrick decode(const EncodedBrick& brick, const LatticePosition& origin, std::uint32_t offset_bits,
                                std::span<const CodedAttribute> attributes) = 0;
    /// See recode_brick().
    virtual EncodedBrick recode(const EncodedBrick& brick, std::uint32_t offset_bits,
                                std::span<const CodedAttribute> attributes, const CodingOptions& options) = 0;
};

/// With the loops of one instruction set, which the processor has.
template <InstructionSet>
std::unique_ptr<LatticeCoder> make_lattice_coder();
/// With those of chosen_instruction_set().
std::unique_ptr<LatticeCoder> make_lattice_coder();

}  // namespace meniscus
