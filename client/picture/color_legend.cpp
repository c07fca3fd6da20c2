#include "picture/color_legend.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "picture/lettering.hpp"

namespace meniscus::cli {
namespace {

constexpr Rgb ink{22, 33, 43};
/// Sizes in pixels of the letters.
constexpr std::size_t bar_height = 8;
constexpr std::size_t space = 4;
constexpr std::size_t strip = letter_height + space + bar_height + space + letter_height + 2 * space;

std::size_t scale_of(std::size_t height) {
    return std::max<std::size_t>(1, (height + 100) / 300);
}

/// Its middle is at x.
void draw_centered(formats::Image& image, const std::string& text, std::size_t x, std::size_t y, std::size_t scale) {
    const std::size_t half = text_width(text, scale) / 2;
    draw_text(image, text, static_cast<std::ptrdiff_t>(x) - static_cast<std::ptrdiff_t>(half),
              static_cast<std::ptrdiff_t>(y), scale, ink);
}

/// As many as have room beside each other.
std::vector<double> fitting_ticks(const ValueRange& range, std::size_t width, std::size_t scale) {
    const double extent = range.high - range.low;
    for (std::size_t most = 9; most > 1; --most) {
        std::vector<double> chosen = ticks(range, most);
        std::size_t widest = 0;
        for (const double tick : chosen) widest = std::max(widest, text_width(value_text(tick, extent), scale));
        if (chosen.size() < 2 ||
            static_cast<double>(widest + 12 * scale) <= static_cast<double>(width) * (chosen[1] - chosen[0]) / extent)
            return chosen;
    }
    return ticks(range, 1);
}

}  // namespace

std::size_t legend_height(std::size_t height) {
    return std::min(height / 2, strip * scale_of(height));
}

void draw_legend(formats::Image& image, const ColorLegend& legend) {
    const std::size_t scale = scale_of(image.height);
    const std::size_t middle = image.width / 2;
    std::size_t y = image.height - std::min(image.height, strip * scale) + space * scale;
    draw_centered(image, legend.title, middle, y, scale);
    if (!legend.range) return;
    y += (letter_height + space) * scale;
    const std::size_t width = std::max<std::size_t>(1, std::min(image.width * 4 / 5, 260 * scale));
    const std::size_t left = middle - width / 2;
    const auto at = [](std::size_t place) { return static_cast<std::ptrdiff_t>(place); };
    fill(image, at(left) - 1, at(y) - 1, width + 2, bar_height * scale + 2, ink);
    for (std::size_t x = 0; x < width; ++x) {
        const double part = width > 1 ? static_cast<double>(x) / static_cast<double>(width - 1) : 0.5;
        fill(image, at(left + x), at(y), 1, bar_height * scale, color_of(legend.map, part));
    }
    y += bar_height * scale;
    const ValueRange& range = *legend.range;
    for (const double tick : fitting_ticks(range, width, scale)) {
        const auto x =
            static_cast<std::size_t>(std::lround(part_of(tick, range) * static_cast<double>(width - 1))) + left;
        fill(image, at(x), at(y), std::max<std::size_t>(1, scale / 2), 3 * scale, ink);
        draw_centered(image, value_text(tick, range.high - range.low), x, y + space * scale, scale);
    }
}

}  // namespace meniscus::cli
