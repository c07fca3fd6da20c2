// Triangles to pixels: a z-buffer with several samples per pixel.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "formats/pictures/png.hpp"

namespace meniscus::cli {

/// Linear light, 0 to 1.
using Color = std::array<float, 3>;

/// A corner on the screen.
struct ScreenPoint {
    float x = 0.0F;      ///< pixels from the left
    float y = 0.0F;      ///< pixels from the top
    float depth = 0.0F;  ///< distance to the viewer, in any unit, > 0
};

/// A place within a triangle.
struct Fragment {
    std::array<float, 3> weights{};  ///< of the corners; they sum to 1
    float edge_distance = 0.0F;      ///< to the nearest edge, pixels
};

class Rasterizer {
public:
    /// samples: per pixel and axis.
    Rasterizer(std::size_t width, std::size_t height, std::size_t samples)
        : samples_(samples),
          width_(width * samples),
          height_(height * samples),
          depth_(width_ * height_, std::numeric_limits<float>::infinity()),
          color_(width_ * height_) {}

    /// Fills every sample with the color of its row; row: 0 at the top to 1 at the bottom.
    template <class Background>
    void clear(const Background& background) {
        for (std::size_t y = 0; y < height_; ++y) {
            const Stored stored = store(background((static_cast<float>(y) + 0.5F) / static_cast<float>(height_)));
            std::fill_n(color_.begin() + static_cast<std::ptrdiff_t>(y * width_), width_, stored);
        }
    }

    /// Draws a triangle of either orientation where nothing nearer has been drawn; shade: Fragment to Color.
    template <class Shade>
    void draw(const std::array<ScreenPoint, 3>& triangle, const Shade& shade);

    /// The mean of each pixel's samples, in sRGB.
    formats::Image image() const;

private:
    /// Square roots of linear light in 8 bits: close to how the eye sees, and quick to average.
    using Stored = std::array<std::uint8_t, 3>;
    static Stored store(const Color& color);

    std::size_t samples_;
    std::size_t width_;  ///< in samples, as is the height
    std::size_t height_;
    std::vector<float> depth_;
    std::vector<Stored> color_;
};

template <class Shade>
void Rasterizer::draw(const std::array<ScreenPoint, 3>& triangle, const Shade& shade) {
    const auto scale = static_cast<float>(samples_);
    std::array<float, 3> x{};
    std::array<float, 3> y{};
    for (std::size_t i = 0; i < 3; ++i) {
        x[i] = triangle[i].x * scale;
        y[i] = triangle[i].y * scale;
    }
    const float area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    if (!(std::abs(area) > 0.0F)) return;  // NaN too
    const auto [left, right] = std::minmax({x[0], x[1], x[2]});
    const auto [top, bottom] = std::minmax({y[0], y[1], y[2]});
    const auto first = [](float low) { return static_cast<std::size_t>(std::max(0.0F, std::ceil(low - 0.5F))); };
    const auto last = [](float high, std::size_t size) {
        return static_cast<std::size_t>(std::clamp(std::floor(high + 0.5F), 0.0F, static_cast<float>(size)));
    };
    // Corner i's weight is the distance to the edge opposite, as a part of the triangle's height over it.
    std::array<float, 3> height{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t a = (i + 1) % 3;
        const std::size_t b = (i + 2) % 3;
        height[i] = std::abs(area) / std::hypot(x[b] - x[a], y[b] - y[a]) / scale;
    }
    for (std::size_t py = first(top); py < last(bottom, height_); ++py)
        for (std::size_t px = first(left); px < last(right, width_); ++px) {
            const float sx = static_cast<float>(px) + 0.5F;
            const float sy = static_cast<float>(py) + 0.5F;
            Fragment fragment;
            auto& w = fragment.weights;
            w[0] = ((x[1] - sx) * (y[2] - sy) - (x[2] - sx) * (y[1] - sy)) / area;
            w[1] = ((x[2] - sx) * (y[0] - sy) - (x[0] - sx) * (y[2] - sy)) / area;
            w[2] = 1.0F - w[0] - w[1];
            if (w[0] < 0.0F || w[1] < 0.0F || w[2] < 0.0F) continue;
            // The inverse of depth is linear on the screen.
            const float depth = 1.0F / (w[0] / triangle[0].depth + w[1] / triangle[1].depth + w[2] / triangle[2].depth);
            const std::size_t at = py * width_ + px;
            if (!(depth < depth_[at])) continue;
            depth_[at] = depth;
            fragment.edge_distance = std::min({w[0] * height[0], w[1] * height[1], w[2] * height[2]});
            color_[at] = store(shade(fragment));
        }
}

}  // namespace meniscus::cli
