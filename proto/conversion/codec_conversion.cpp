#include "conversion/codec_conversion.hpp"

#include <algorithm>
#include <string>

#include "meniscus/error.hpp"

namespace meniscus::conversion {

static_assert(static_cast<int>(Codec::draco) == int{v1::CODEC_DRACO});
static_assert(codecs.size() == v1::Codec_ARRAYSIZE - 1, "every codec of the contract has a row in core's table");

v1::Codec to_wire(Codec codec) {
    return static_cast<v1::Codec>(codec);
}

void add_known_codecs(google::protobuf::RepeatedField<int>& wire) {
    for (const Codec known : codecs) wire.Add(to_wire(known));
}

Codec chosen_codec(const google::protobuf::RepeatedField<int>& taken) {
    for (const int number : taken)
        if (!codec_by_number(static_cast<std::uint32_t>(number)))
            throw InvalidInput("codecs has the value " + std::to_string(number) +
                               ", which this version does not offer; it offers " + known_codecs());
    for (const Codec known : codecs)
        if (std::ranges::find(taken, int{to_wire(known)}) != taken.end()) return known;
    return Codec::draco;
}

}  // namespace meniscus::conversion
