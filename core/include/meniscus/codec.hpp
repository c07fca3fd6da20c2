// The codecs of bricks, and their numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace meniscus {

/// On the wire and in files a codec is its number, which it keeps for ever.
enum class Codec : std::uint32_t { draco = 1 };

/// Every codec, the preferred one first. After one is added here, the compiler reports each switch over codecs that
/// lacks it.
inline constexpr std::array codecs{Codec::draco};

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
