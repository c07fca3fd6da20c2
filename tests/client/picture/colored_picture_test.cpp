// Pictures colored by an attribute: the colors, their legend, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/cli_fixture.hpp"
#include "meniscus/error.hpp"
#include "picture/color_maps.hpp"
#include "picture/id_palette.hpp"
#include "picture/lettering.hpp"
#include "picture/picture.hpp"
#include "picture/shown_values.hpp"
#include "sample_values.hpp"

namespace meniscus::cli {
namespace {

/// A square that faces the viewer, its left vertices 0 and 1, its right ones 2 and 3.
formats::TriangleMesh square(formats::NamedValues values) {
    formats::TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 4, 0}, {4, 0, 0}, {4, 4, 0}};
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}};
    mesh.attributes.push_back(std::move(values));
    return mesh;
}

PictureOptions options(const std::string& color) {
    PictureOptions options;
    options.width = 400;
    options.height = 300;
    options.azimuth = 0.0;
    options.elevation = 0.0;
    options.color = color;
    return options;
}

Rgb color_at(const formats::Image& image, std::size_t x, std::size_t y) {
    const std::size_t at = 3 * (y * image.width + x);
    return {image.pixels[at], image.pixels[at + 1], image.pixels[at + 2]};
}

/// Whether one is the other, lighter or darker, up to rounding.
void expect_shade_of(const Rgb& seen, const Rgb& color) {
    std::array<double, 2> lengths{};
    double product = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        lengths[0] += static_cast<double>(seen[c]) * seen[c];
        lengths[1] += static_cast<double>(color[c]) * color[c];
        product += static_cast<double>(seen[c]) * color[c];
    }
    EXPECT_GT(product, 0.998 * std::sqrt(lengths[0] * lengths[1]))
        << int{seen[0]} << ' ' << int{seen[1]} << ' ' << int{seen[2]} << " is no shade of " << int{color[0]} << ' '
        << int{color[1]} << ' ' << int{color[2]};
}

bool has_pixel(const formats::Image& image, const Rgb& color, std::size_t from_row) {
    for (std::size_t y = from_row; y < image.height; ++y)
        for (std::size_t x = 0; x < image.width; ++x)
            if (color_at(image, x, y) == color) return true;
    return false;
}

TEST(ColorMaps, BeginAndEndWithTheirPublishedColors) {
    EXPECT_EQ(color_of(ColorMap::viridis, 0.0), (Rgb{68, 1, 84}));
    EXPECT_EQ(color_of(ColorMap::viridis, 1.0), (Rgb{253, 231, 37}));
    EXPECT_EQ(color_of(ColorMap::viridis, 7.0), (Rgb{253, 231, 37}));
    EXPECT_EQ(color_of(ColorMap::magma, -1.0), (Rgb{0, 0, 4}));
    EXPECT_EQ(color_of(ColorMap::plasma, 1.0), (Rgb{240, 249, 33}));
    EXPECT_EQ(color_of(ColorMap::cividis, 1.0), (Rgb{255, 234, 70}));
    EXPECT_EQ(color_of(ColorMap::coolwarm, 0.0), (Rgb{59, 76, 192}));
    EXPECT_EQ(color_of(ColorMap::coolwarm, 1.0), (Rgb{180, 4, 38}));
    // Published in Moreland's table.
    const Rgb quarter = color_of(ColorMap::coolwarm, 0.25);
    EXPECT_NEAR(quarter[0], 141, 1);
    EXPECT_NEAR(quarter[1], 176, 1);
    EXPECT_NEAR(quarter[2], 254, 1);
}

TEST(IdPalette, HasTheColorsOfTheViewer) {
    EXPECT_EQ(color_of_id(0), (Rgb{177, 37, 37}));
    EXPECT_EQ(color_of_id(1), (Rgb{87, 125, 219}));
    EXPECT_EQ(color_of_id(2), (Rgb{150, 214, 61}));
    EXPECT_EQ(color_of_id(static_cast<std::uint32_t>(-7)), (Rgb{68, 61, 214}));
}

TEST(ValueRange, HasRoundTicksWithin) {
    EXPECT_EQ(ticks({0.0, 5.0}, 6), (std::vector<double>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(ticks({0.0, 5.0}, 5), (std::vector<double>{0, 2, 4}));
    EXPECT_EQ(ticks({-1.3, 1.1}, 3), (std::vector<double>{-1, 0, 1}));
    EXPECT_EQ(ticks({3.0, 3.0}, 6), (std::vector<double>{3}));
    EXPECT_EQ(value_text(0.1 + 0.2, 5.0), "0.3");
    EXPECT_EQ(value_text(1e6 + 0.25, 1.0), "1000000.25");
    EXPECT_EQ(value_text(-0.0, 1.0), "0");
}

TEST(ShownValues, AreMagnitudesComponentsColorsOrIds) {
    const auto velocity =
        square(test::values_of<float>("velocity", ElementType::float32, 3, {3, 4, 0, 0, 0, 2, -1, 0, 0, 0, 0, 0}));
    EXPECT_EQ(values_to_show(velocity, "velocity").numbers, (std::vector<float>{5, 2, 1, 0}));
    EXPECT_EQ(values_to_show(velocity, "velocity").title, "velocity, magnitude");
    const ShownValues x = values_to_show(velocity, "velocity.x");
    EXPECT_EQ(x.numbers, (std::vector<float>{3, 0, -1, 0}));
    EXPECT_EQ(x.range->low, -1.0);
    EXPECT_EQ(x.range->high, 3.0);
    const std::vector<std::uint8_t> bytes{255, 0, 9, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    const ShownValues color = values_to_show(square(test::values_of("color", ElementType::uint8, 3, bytes)), "color");
    EXPECT_EQ(color.colors[0], (Rgb{255, 0, 9}));
    EXPECT_FALSE(color.nearest);
    EXPECT_FALSE(
        values_to_show(square(test::values_of("bytes", ElementType::uint8, 3, bytes)), "bytes").numbers.empty());
    const ShownValues ids =
        values_to_show(square(test::values_of<std::int32_t>("id", ElementType::int32, 1, {0, 1, -7, 2})), "id");
    EXPECT_EQ(ids.colors[2], color_of_id(static_cast<std::uint32_t>(-7)));
    EXPECT_TRUE(ids.nearest);
}

TEST(ShownValues, AreFoundByTheNameThatTheFileOfTheParticlesHas) {
    const auto mesh = square(test::values_of<float>("temperature__k_", ElementType::float32, 1, {0, 1, 2, 3}));
    EXPECT_EQ(values_to_show(mesh, "Temperature (K)").numbers, (std::vector<float>{0, 1, 2, 3}));
}

TEST(ShownValues, AreRefusedWithWhatThereIs) {
    const auto mesh = square(test::values_of<float>("age", ElementType::float32, 1, {0, 1, 2, 3}));
    for (const auto& [what, words] : std::vector<std::pair<std::string, std::string>>{
             {"velocity", "no attribute 'velocity' to color by; it has age"},
             {"age.y", "'age' has no component y: it has 1"}})
        try {
            values_to_show(mesh, what);
            FAIL() << what;
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
    EXPECT_THROW(values_to_show({}, "age"), InvalidInput);
}

TEST(ColoredPicture, ShowsEachValueInItsColor) {
    const auto mesh = square(test::values_of<float>("speed", ElementType::float32, 1, {0, 0, 5, 5}));
    const formats::Image image = draw_picture(mesh, options("speed"));
    // The square is as high as what the legend leaves; its corners are near these columns.
    const std::size_t row = 100;
    std::vector<std::size_t> columns;
    const Rgb background = color_at(image, 0, row);
    for (std::size_t x = 0; x < image.width; ++x)
        if (color_at(image, x, row) != background) columns.push_back(x);
    ASSERT_GT(columns.size(), 100U);
    const std::size_t left = columns.front();
    const std::size_t width = columns.back() - left;
    for (const double part : {0.1, 0.5, 0.9})
        expect_shade_of(color_at(image, left + static_cast<std::size_t>(part * static_cast<double>(width)), row),
                        color_of(ColorMap::viridis, part));
}

TEST(ColoredPicture, HasALegendBelow) {
    const auto mesh = square(test::values_of<float>("speed", ElementType::float32, 1, {0, 0, 5, 5}));
    PictureOptions wanted = options("speed");
    wanted.color_map = ColorMap::coolwarm;
    const formats::Image image = draw_picture(mesh, wanted);
    for (const double part : {0.0, 1.0}) EXPECT_TRUE(has_pixel(image, color_of(ColorMap::coolwarm, part), 250)) << part;
}

TEST(ColoredPicture, ClampsToARangeByHand) {
    const auto mesh = square(test::values_of<float>("speed", ElementType::float32, 1, {7, 7, 7, 7}));
    PictureOptions wanted = options("speed");
    wanted.range = ValueRange{0.0, 1.0};
    expect_shade_of(color_at(draw_picture(mesh, wanted), 200, 100), color_of(ColorMap::viridis, 1.0));
    wanted.range.reset();
    expect_shade_of(color_at(draw_picture(mesh, wanted), 200, 100), color_of(ColorMap::viridis, 0.5));
}

TEST(ColoredPicture, MixesColorsAndNoIds) {
    const std::vector<std::uint8_t> bytes{200, 0, 0, 200, 0, 0, 0, 0, 200, 0, 0, 200};
    expect_shade_of(
        color_at(draw_picture(square(test::values_of("rgb", ElementType::uint8, 3, bytes)), options("rgb")), 200, 100),
        {100, 0, 100});
    const auto ids = square(test::values_of<std::uint32_t>("id", ElementType::uint32, 1, {1, 1, 2, 2}));
    const formats::Image image = draw_picture(ids, options("id"));
    expect_shade_of(color_at(image, 110, 100), color_of_id(1));
    expect_shade_of(color_at(image, 290, 100), color_of_id(2));
}

TEST(ColoredPicture, IsDrawnOfAnEmptyMeshAndInAnySize) {
    auto empty = formats::TriangleMesh{};
    empty.attributes.push_back(test::values_of<float>("speed", ElementType::float32, 1, {}));
    EXPECT_EQ(draw_picture(empty, options("speed")).pixels.size(), 3U * 400U * 300U);
    for (const std::size_t size : {1U, 2U, 7U, 30U}) {
        PictureOptions tiny = options("speed");
        tiny.width = tiny.height = size;
        EXPECT_EQ(
            draw_picture(square(test::values_of<float>("speed", ElementType::float32, 1, {0, 1e30F, -1e30F, 5})), tiny)
                .pixels.size(),
            3 * size * size);
    }
}

TEST(Lettering, IsWrittenInsideOfThePictureAlone) {
    formats::Image image{20, 10, std::vector<std::uint8_t>(3 * 20 * 10, 255)};
    draw_text(image, "velocity_0.5,-+?", -7, -3, 2, {0, 0, 0});
    draw_text(image, "x", 1000, 1000, 3, {0, 0, 0});
    EXPECT_EQ(text_width("ab", 2), 22U);
    EXPECT_EQ(std::ranges::count(image.pixels, std::uint8_t{0}) % 3, 0);
}

using ColoredPictureCommand = test::Cli;

TEST_F(ColoredPictureCommand, DrawsAFileAndRefusesWhatItCannotDraw) {
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string aged =
        write("aged.ply", header + "property float age\n" + face + "0 0 0 1\n1 0 0 2\n0 1 0 3\n3 0 1 2\n");
    const std::string plain = write("plain.ply", header + face + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const std::string out = path("picture.png");
    const auto arguments = [&](const std::string& mesh, const std::vector<std::string>& more) {
        std::vector<std::string> all{"picture", mesh, "-o", out, "--width", "60", "--height", "40"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    const test::ProcessResult drawn =
        test::run_meniscus(arguments(aged, {"--color", "age", "--color-map", "magma", "--range", "-1,5"}));
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    expect_refused(arguments(plain, {"--color", "age"}),
                   {"no attribute 'age' to color by; it has none: reconstruct --attribute NAME"});
    expect_refused(arguments(aged, {"--color", "age", "--range", "5,-1"}), {"--range", "5", "-1", "less"});
    EXPECT_NE(test::run_meniscus(arguments(aged, {"--color", "age", "--wireframe"})).exit_code, 0);
    EXPECT_NE(test::run_meniscus(arguments(aged, {"--color-map", "magma"})).exit_code, 0);
}

}  // namespace
}  // namespace meniscus::cli
