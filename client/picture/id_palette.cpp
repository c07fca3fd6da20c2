// client/web/src/color/id_palette.ts has the same colors.
#include "picture/id_palette.hpp"

#include <algorithm>
#include <cmath>

namespace meniscus::cli {

Rgb color_of_id(std::uint32_t id) {
    // Steps of the golden ratio: ids in a row have hues far apart.
    const std::uint32_t hash = id * 0x9e3779b9U;
    const double hue = 6.0 * hash / 4294967296.0;
    const double lightness = 0.42 + 0.06 * ((hash >> 3U) & 3U);
    const double chroma = (1.0 - std::abs(2.0 * lightness - 1.0)) * 0.65;
    const auto channel = [&](double shift) {
        const double away = std::abs(std::fmod(hue + shift, 6.0) - 3.0) - 1.0;
        return static_cast<std::uint8_t>(
            std::floor(255.0 * (lightness + chroma * (std::clamp(away, 0.0, 1.0) - 0.5)) + 0.5));
    };
    return {channel(0.0), channel(4.0), channel(2.0)};
}

}  // namespace meniscus::cli
