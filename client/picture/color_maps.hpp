// Colors for numbers.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace meniscus::cli {

/// sRGB.
using Rgb = std::array<std::uint8_t, 3>;

enum class ColorMap { viridis, magma, plasma, cividis, coolwarm };
constexpr std::string_view name_of(ColorMap map) {
    switch (map) {
        case ColorMap::viridis:
            return "viridis";
        case ColorMap::magma:
            return "magma";
        case ColorMap::plasma:
            return "plasma";
        case ColorMap::cividis:
            return "cividis";
        case ColorMap::coolwarm:
            return "coolwarm";
    }
    return {};
}

/// Whether its middle, which is pale, stands for zero.
constexpr bool is_diverging(ColorMap map) {
    return map == ColorMap::coolwarm;
}

/// part: from 0 to 1; what lies outside is taken as the nearer end.
Rgb color_of(ColorMap map, double part);

}  // namespace meniscus::cli
