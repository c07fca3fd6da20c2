// The codecs of bricks, and their numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace meniscus {

/// On the wire and in files a codec is its number, which it keeps for ever.
enum class Codec : std::uint32_t {
    draco = 1,            ///< a Draco mesh, for readers of standard meshes
    lattice_packed = 2,   ///< levels, signs and offsets of the lattice at fixed widths: the fastest
    lattice_entropy = 3,  ///< the same content through an entropy coder: the smallest
};

/// Every codec, the preferred one first. After one is added here, the compiler reports each switch over codecs that
/// lacks it.
inline constexpr std::array codecs{Codec::lattice_entropy, Codec::lattice_packed, Codec::draco};

/// None for a number that this version does not know.
constexpr std::optional<Codec> codec_by_number(std::uint32_t number) {
    for (const Codec known : codecs)
        if (static_cast<std::uint32_t>(known) == number) return known;
    return std::nullopt;
}

constexpr std::string_view name_of(Codec codec) {
    switch (codec) {
        case Codec::draco:
            return "Draco";
        case Codec::lattice_packed:
            return "lattice, packed";
        case Codec::lattice_entropy:
            return "lattice, entropy";
    }
    return "";
}

/// Text for messages: "1 (Draco)", all codecs with their numbers.
inline std::string known_codecs() {
    std::string text;
    for (const Codec known : codecs) {
        if (!text.empty()) text += ", ";
        text += std::to_string(static_cast<std::uint32_t>(known)) + " (" + std::string(name_of(known)) + ")";
    }
    return text;
}

}  // namespace meniscus
