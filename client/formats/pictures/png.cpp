#include "formats/pictures/png.hpp"

#include <png.h>

#include <stdexcept>

#include "formats/bytes/atomic_file.hpp"

namespace meniscus::formats {

std::string png_bytes(const Image& image) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.format = PNG_FORMAT_RGB;
    header.width = static_cast<png_uint_32>(image.width);
    header.height = static_cast<png_uint_32>(image.height);
    const auto encode = [&](void* out, png_alloc_size_t& size) {
        if (png_image_write_to_memory(&header, out, &size, 0, image.pixels.data(), 0, nullptr) == 0)
            throw std::runtime_error("the picture cannot be made: " + std::string(header.message));
    };
    png_alloc_size_t size = 0;
    encode(nullptr, size);
    std::string bytes(size, '\0');
    encode(bytes.data(), size);
    bytes.resize(size);
    return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) {
    write_file(path, png_bytes(image));
}

}  // namespace meniscus::formats
