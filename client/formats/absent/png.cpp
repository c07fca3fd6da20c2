// A build without libpng.
#include "formats/pictures/png.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {

std::string png_bytes(const Image& /*image*/) {
    throw NotBuilt("a picture (.png)", "libpng: build it where libpng-dev is installed");
}

void write_png(const std::filesystem::path& /*path*/, const Image& image) {
    png_bytes(image);
}

}  // namespace meniscus::formats
