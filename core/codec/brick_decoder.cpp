// Bytes from anywhere become a brick, or a refusal.
#include <limits>
#include <memory>
#include <string>

#include "codec/attribute_values.hpp"
#include "codec/brick_refusal.hpp"
#include "codec/draco_bricks.hpp"
#include "codec/lattice/lattice_coder.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/error.hpp"

namespace meniscus {

void refuse(const EncodedBrick& brick, const std::string& what) {
    throw InvalidInput("brick (" + std::to_string(brick.coordinate[0]) + ", " + std::to_string(brick.coordinate[1]) +
                       ", " + std::to_string(brick.coordinate[2]) + "): " + what);
}

namespace {

void require_offset_bits(std::uint32_t offset_bits) {
    if (offset_bits < min_offset_bits || offset_bits > max_offset_bits)
        throw InvalidInput("the mesh has " + std::to_string(offset_bits) + " offset bits, must have " +
                           std::to_string(min_offset_bits) + " to " + std::to_string(max_offset_bits));
}

}  // namespace

LatticePosition brick_origin(const EncodedBrick& brick, std::uint32_t offset_bits) {
    require_offset_bits(offset_bits);
    const std::int64_t edge = std::int64_t{brick_cells} << offset_bits;
    LatticePosition origin;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t low = brick.coordinate[axis] * edge;
        if (low < std::numeric_limits<std::int32_t>::min() || low + edge > std::numeric_limits<std::int32_t>::max())
            refuse(brick, "lies beyond the lattice");
        origin[axis] = static_cast<std::int32_t>(low);
    }
    return origin;
}

namespace {

DecodedBrick decode_lattice_brick(const EncodedBrick& brick, const LatticePosition& origin, std::uint32_t offset_bits,
                                  std::span<const CodedAttribute> attributes) {
    thread_local const std::unique_ptr<LatticeCoder> coder = make_lattice_coder();
    try {
        return coder->decode(brick, origin, offset_bits, attributes);
    } catch (const InvalidInput& fault) {
        refuse(brick, fault.what());
    }
}

}  // namespace

DecodedBrick decode_brick(const EncodedBrick& brick, std::uint32_t offset_bits,
                          std::span<const CodedAttribute> attributes) {
    for (const CodedAttribute& form : attributes) require_codable(form);
    const LatticePosition origin = brick_origin(brick, offset_bits);
    switch (brick.codec) {
        case Codec::draco:
            return decode_draco(brick, origin, offset_bits, attributes);
        case Codec::lattice_packed:
        case Codec::lattice_entropy:
            return decode_lattice_brick(brick, origin, offset_bits, attributes);
    }
    refuse(brick, "has the codec " + std::to_string(static_cast<std::uint32_t>(brick.codec)) +
                      ", which this version does not know; it knows " + known_codecs());
}

}  // namespace meniscus
