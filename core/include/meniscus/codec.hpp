// The codecs of bricks, and their numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "meniscus/names.hpp"

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
            return "draco";
        case Codec::lattice_packed:
            return "packed";
        case Codec::lattice_entropy:
            return "entropy";
    }
    return "";
}
namespace detail {
template <>  // their numbers do not count from 0
struct Choices<Codec> {
    static constexpr auto all = codecs;
};
}  // namespace detail

/// Whether it codes Mesh::lattice, in place of the mesh.
constexpr bool needs_lattice(Codec codec) {
    switch (codec) {
        case Codec::draco:
            return false;
        case Codec::lattice_packed:
        case Codec::lattice_entropy:
            return true;
    }
    return false;
}

/// Text for messages: "1 (draco)", all codecs with their numbers.
inline std::string known_codecs() {
    std::string text;
    for (const Codec known : codecs) {
        if (!text.empty()) text += ", ";
        text += std::to_string(static_cast<std::uint32_t>(known)) + " (" + std::string(name_of(known)) + ")";
    }
    return text;
}

}  // namespace meniscus
