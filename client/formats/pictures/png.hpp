// Pictures to PNG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace meniscus::formats {

/// 8-bit sRGB, three bytes per pixel, rows from the top.
struct Image {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<std::uint8_t> pixels;
};

/// The content of the file.
std::string png_bytes(const Image& image);
/// Atomic. Throws InvalidInput if the path cannot be written.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace meniscus::formats
