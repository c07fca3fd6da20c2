#include <gtest/gtest.h>

#include "picture/picture.hpp"
#include "picture/rasterizer.hpp"

namespace meniscus::cli {
namespace {

std::array<std::uint8_t, 3> pixel(const formats::Image& image, std::size_t x, std::size_t y) {
    const std::size_t at = 3 * (y * image.width + x);
    return {image.pixels[at], image.pixels[at + 1], image.pixels[at + 2]};
}

constexpr std::array<std::uint8_t, 3> black{0, 0, 0};
constexpr std::array<std::uint8_t, 3> white{255, 255, 255};
constexpr std::array<std::uint8_t, 3> red{255, 0, 0};

const auto paint_red = [](const Fragment&) { return Color{1.0F, 0.0F, 0.0F}; };
const auto paint_white = [](const Fragment&) { return Color{1.0F, 1.0F, 1.0F}; };

TEST(Rasterizer, CoversThePixelsWhoseCentersLieInside) {
    Rasterizer rasterizer(8, 8, 1);
    rasterizer.draw({{{0.0F, 0.0F, 1.0F}, {8.0F, 0.0F, 1.0F}, {0.0F, 8.0F, 1.0F}}}, paint_white);
    const formats::Image image = rasterizer.image();
    for (std::size_t y = 0; y < 8; ++y)
        for (std::size_t x = 0; x < 8; ++x) EXPECT_EQ(pixel(image, x, y), x + y < 8 ? white : black) << x << ", " << y;
}

TEST(Rasterizer, CoversASquareOfTwoTrianglesWithoutGap) {
    Rasterizer rasterizer(16, 16, 3);
    rasterizer.draw({{{2.3F, 1.7F, 1.0F}, {13.1F, 3.9F, 1.0F}, {4.6F, 14.2F, 1.0F}}}, paint_white);
    rasterizer.draw({{{13.1F, 3.9F, 1.0F}, {14.0F, 14.0F, 1.0F}, {4.6F, 14.2F, 1.0F}}}, paint_white);
    EXPECT_EQ(pixel(rasterizer.image(), 9, 8), white);  // on the common edge
}

TEST(Rasterizer, TheNearerTriangleWinsInAnyOrder) {
    for (const bool near_first : {true, false}) {
        Rasterizer rasterizer(4, 4, 1);
        for (int i = 0; i < 2; ++i) {
            const bool near = (i == 0) == near_first;
            const float depth = near ? 1.0F : 2.0F;
            const std::array<ScreenPoint, 3> triangle{
                {{-9.0F, -9.0F, depth}, {20.0F, -9.0F, depth}, {-9.0F, 20.0F, depth}}};
            if (near)
                rasterizer.draw(triangle, paint_red);
            else
                rasterizer.draw(triangle, paint_white);
        }
        EXPECT_EQ(pixel(rasterizer.image(), 2, 2), red);
    }
}

TEST(Rasterizer, SmoothsEdgesBySeveralSamples) {
    Rasterizer rasterizer(1, 1, 2);
    rasterizer.draw({{{0.0F, -1.0F, 1.0F}, {0.5F, -1.0F, 1.0F}, {0.5F, 9.0F, 1.0F}}},
                    paint_white);  // the left half, roughly
    rasterizer.draw({{{0.0F, -1.0F, 1.0F}, {0.0F, 9.0F, 1.0F}, {0.5F, 9.0F, 1.0F}}}, paint_white);
    EXPECT_NEAR(pixel(rasterizer.image(), 0, 0)[0], 188, 2);  // half of the light, in sRGB
}

TEST(Rasterizer, GivesTheDistanceToTheNearestEdge) {
    Rasterizer rasterizer(20, 20, 2);
    float largest = 0.0F;
    rasterizer.draw({{{0.0F, 0.0F, 1.0F}, {20.0F, 0.0F, 1.0F}, {0.0F, 20.0F, 1.0F}}}, [&](const Fragment& fragment) {
        largest = std::max(largest, fragment.edge_distance);
        return Color{};
    });
    EXPECT_NEAR(largest, 20.0 / (2.0 + std::sqrt(2.0)), 0.5);  // the inscribed circle's radius
}

TEST(Rasterizer, IgnoresTrianglesWithoutAreaOrOutside) {
    Rasterizer rasterizer(4, 4, 1);
    rasterizer.draw({{{1.0F, 1.0F, 1.0F}, {2.0F, 2.0F, 1.0F}, {3.0F, 3.0F, 1.0F}}}, paint_white);
    rasterizer.draw({{{-9.0F, 1.0F, 1.0F}, {-2.0F, 2.0F, 1.0F}, {-3.0F, 3.0F, 1.0F}}}, paint_white);
    rasterizer.draw({{{91.0F, 1.0F, 1.0F}, {92.0F, 2.0F, 1.0F}, {93.0F, 1.0F, 1.0F}}}, paint_white);
    for (const std::uint8_t value : rasterizer.image().pixels) EXPECT_EQ(value, 0);
}

TEST(Camera, FitsThePointsWithUpUpwards) {
    const std::vector<Vector3> points{{-3, 0, 5}, {7, 1, 2}, {0, 9, 0}, {1, 2, -4}};
    for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
        const Camera camera(points, up, 35.0, 20.0, 300, 200);
        float left = 300.0F;
        float right = 0.0F;
        float top = 200.0F;
        float bottom = 0.0F;
        for (const Vector3& p : points) {
            const ScreenPoint s = camera.project(p);
            EXPECT_GT(s.depth, 0.0F);
            left = std::min(left, s.x);
            right = std::max(right, s.x);
            top = std::min(top, s.y);
            bottom = std::max(bottom, s.y);
        }
        EXPECT_NEAR(left + right, 300.0F, 0.1F);
        EXPECT_NEAR(top + bottom, 200.0F, 0.1F);
        EXPECT_TRUE(std::abs(left - 15.0F) < 0.1F || std::abs(top - 10.0F) < 0.1F);
        EXPECT_GE(left, 14.9F);
        EXPECT_GE(top, 9.9F);
    }
    const Camera y_up(points, UpAxis::y, 35.0, 20.0, 300, 200);
    EXPECT_LT(y_up.project({0, 9, 0}).y, y_up.project({0, 0, 0}).y);
    const Camera z_up(points, UpAxis::z, 35.0, 20.0, 300, 200);
    EXPECT_LT(z_up.project({0, 0, 9}).y, z_up.project({0, 0, 0}).y);
}

TEST(Picture, WireframeColorsLevelsDifferentlyAndHidesLines) {
    formats::TriangleMesh mesh;
    // One large triangle per level, each in its own quarter, and one behind the first.
    for (const unsigned level : {0U, 1U, 2U, 3U}) {
        const double x = (level & 1U) != 0 ? 10.0 : 0.0;
        const double y = level > 1 ? 10.0 : 0.0;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {{x, y, 0}, {x + 9, y, 0}, {x, y + 9, 0}});
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.levels.push_back(static_cast<std::uint8_t>(level));
    }
    PictureOptions options;
    options.width = 200;
    options.height = 200;
    options.wireframe = true;
    options.azimuth = 0.0;
    options.elevation = 0.0;
    const formats::Image image = draw_picture(mesh, options);
    // The left edges of the four triangles: the most colorful pixel around each.
    const auto color_of_line = [&](std::size_t row) {
        std::array<std::array<std::uint8_t, 3>, 2> colors{};
        for (std::size_t half = 0; half < 2; ++half) {
            int best = -1;
            for (std::size_t x = half * 100; x < half * 100 + 30; ++x) {
                const auto p = pixel(image, x, row);
                const int spread = *std::max_element(p.begin(), p.end()) - *std::min_element(p.begin(), p.end());
                if (spread > best) {
                    best = spread;
                    colors[half] = p;
                }
            }
        }
        return colors;
    };
    const auto [crack, level1] = color_of_line(170);
    const auto [level2, level3] = color_of_line(75);
    EXPECT_GT(level1[2], level1[0] + 30);  // blue
    EXPECT_GT(level2[1], level2[0] + 30);  // green
    EXPECT_GT(level3[0], level3[2] + 30);  // red
    EXPECT_GT(crack[0], crack[1] + 30);    // purple
    EXPECT_GT(crack[2], crack[1] + 30);
}

TEST(Picture, DrawsAnEmptyMeshAsBackground) {
    const formats::Image image = draw_picture({}, {});
    EXPECT_EQ(image.width, 1200U);
    EXPECT_EQ(image.pixels.size(), 3U * 1200U * 800U);
}

}  // namespace
}  // namespace meniscus::cli
