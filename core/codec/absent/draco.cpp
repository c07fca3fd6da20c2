// A build without Draco.
#include "codec/draco_bricks.hpp"
#include "meniscus/error.hpp"

namespace meniscus {
namespace {

[[noreturn]] void refuse_codec() {
    throw NotBuilt("the codec draco",
                   "Draco: take the codecs packed and entropy, or build it where libdraco-dev 1.5 is installed");
}

}  // namespace

std::vector<std::byte> encode_draco(const BrickContent& /*content*/, const CodingOptions& /*options*/) {
    refuse_codec();
}

DecodedBrick decode_draco(const EncodedBrick& /*brick*/, const LatticePosition& /*origin*/,
                          std::uint32_t /*offset_bits*/, std::span<const CodedAttribute> /*attributes*/) {
    refuse_codec();
}

}  // namespace meniscus
