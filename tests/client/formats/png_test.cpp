#include <gtest/gtest.h>
#include <png.h>

#include "formats/pictures/png.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

TEST(PngWriter, IsDecodedToTheSamePixels) {
    const TemporaryDirectory directory;
    formats::Image image{3, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 1, 2, 3, 4, 5, 6, 7, 8, 9}};
    const std::string path = (directory / "a.png").string();
    formats::write_png(path, image);
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&header, path.c_str()), 0);
    header.format = PNG_FORMAT_RGB;
    EXPECT_EQ(header.width, 3U);
    EXPECT_EQ(header.height, 2U);
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(header));
    ASSERT_NE(png_image_finish_read(&header, nullptr, pixels.data(), 0, nullptr), 0);
    EXPECT_EQ(pixels, image.pixels);
}

TEST(PngWriter, RefusesAPathThatCannotBeWritten) {
    EXPECT_NE(refusal([] {
                  formats::write_png("/no/such/folder/a.png", {1, 1, {0, 0, 0}});
              }).find("cannot be written"),
              std::string::npos);
}

}  // namespace
}  // namespace meniscus::test
