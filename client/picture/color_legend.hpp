// What the colors of a picture stand for: a bar with numbers below it and a title above.
#pragma once

#include <optional>
#include <string>

#include "formats/pictures/png.hpp"
#include "picture/color_maps.hpp"
#include "picture/value_range.hpp"

namespace meniscus::cli {

struct ColorLegend {
    std::string title;
    ColorMap map = ColorMap::viridis;
    std::optional<ValueRange> range;  ///< none where each value has its own color: the title alone is drawn
};

/// Of the strip at the lower end of a picture that a legend takes, pixels. height: of the picture.
std::size_t legend_height(std::size_t height);

void draw_legend(formats::Image& image, const ColorLegend& legend);

}  // namespace meniscus::cli
