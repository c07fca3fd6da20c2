#include "conversion/codec_conversion.hpp"

#include <cstdint>
#include <string>

#include "meniscus/error.hpp"

namespace meniscus::conversion {

static_assert(static_cast<int>(Codec::draco) == int{v1::CODEC_DRACO});
static_assert(static_cast<int>(Codec::lattice_packed) == int{v1::CODEC_LATTICE_PACKED});
static_assert(static_cast<int>(Codec::lattice_entropy) == int{v1::CODEC_LATTICE_ENTROPY});
static_assert(codecs.size() == v1::Codec_ARRAYSIZE - 1, "every codec of the contract has a row in core's table");

v1::Codec to_wire(Codec codec) {
    return static_cast<v1::Codec>(codec);
}

void add_known_codecs(google::protobuf::RepeatedField<int>& wire) {
    for (const Codec known : codecs) wire.Add(to_wire(known));
}

std::vector<Codec> named_codecs(const google::protobuf::RepeatedField<int>& wire) {
    std::vector<Codec> named;
    for (const int number : wire) {
        const auto codec = codec_by_number(static_cast<std::uint32_t>(number));
        if (!codec)
            throw InvalidInput("codecs has the value " + std::to_string(number) +
                               ", which this version does not offer; it offers " + known_codecs());
        named.push_back(*codec);
    }
    return named;
}

}  // namespace meniscus::conversion
