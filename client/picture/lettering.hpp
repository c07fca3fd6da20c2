// Words in pictures: five by seven pixels a letter, since no library that is needed anyway has letters. Names of
// attributes and numbers need few of them.
#pragma once

#include <cstddef>
#include <string_view>

#include "formats/pictures/png.hpp"
#include "picture/color_maps.hpp"

namespace meniscus::cli {

inline constexpr std::size_t letter_height = 7;

/// Pixels, of letters that are `scale` times as large.
std::size_t text_width(std::string_view text, std::size_t scale);

/// x, y: of the text's upper left corner; what lies beyond the picture is left out. Letters are a-z, 0-9 and _.,+- and
/// the space; others are drawn as a box.
void draw_text(formats::Image& image, std::string_view text, std::ptrdiff_t x, std::ptrdiff_t y, std::size_t scale,
               const Rgb& color);

/// A rectangle of one color.
void fill(formats::Image& image, std::ptrdiff_t x, std::ptrdiff_t y, std::size_t width, std::size_t height,
          const Rgb& color);

}  // namespace meniscus::cli
