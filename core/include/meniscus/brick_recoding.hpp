// Lattice bricks that were encoded elsewhere: read in counted memory, and encoded again in another form.
#pragma once

#include <cstdint>
#include <span>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/brick_coding.hpp"

namespace meniscus {

/// As decode_brick(), of a lattice codec alone, in scratch memory. Throws LimitExceeded, too, if the account of that
/// would pass its limit.
DecodedBrick decode_brick(const EncodedBrick& brick, std::uint32_t offset_bits,
                          std::span<const CodedAttribute> attributes, BrickScratch& scratch);

/// The bits of a component of the brick's normals; 0: it has none. Throws InvalidInput for bytes that no lattice brick
/// of this version begins with.
int normal_bits_of(const EncodedBrick& brick);

/// Encodes a brick of a lattice codec again, with any codec. attributes: those that the brick carries. options:
/// position_bits and attributes as for a mesh with these offset bits, each attribute one of the brick's; normals and
/// values of more bits than the brick has are no more exact than it. Throws as decode_brick().
EncodedBrick recode_brick(const EncodedBrick& brick, std::uint32_t offset_bits,
                          std::span<const CodedAttribute> attributes, const CodingOptions& options,
                          BrickScratch& scratch);

/// As BrickContent::hash(), of a brick's bytes: equal for equal bytes of which the forms of the attributes are equal.
ContentHash content_hash(const EncodedBrick& brick, const std::vector<CodedAttribute>& attributes);

}  // namespace meniscus
