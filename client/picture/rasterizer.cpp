#include "picture/rasterizer.hpp"

namespace meniscus::cli {
namespace {

std::uint8_t to_srgb(float linear) {
    const float v = linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(v, 0.0F, 1.0F)));
}

}  // namespace

Rasterizer::Stored Rasterizer::store(const Color& color) {
    Stored stored{};
    for (std::size_t i = 0; i < 3; ++i)
        stored[i] = static_cast<std::uint8_t>(std::lround(255.0F * std::sqrt(std::clamp(color[i], 0.0F, 1.0F))));
    return stored;
}

formats::Image Rasterizer::image() const {
    formats::Image out;
    out.width = width_ / samples_;
    out.height = height_ / samples_;
    out.pixels.reserve(3 * out.width * out.height);
    const float full = 255.0F * 255.0F * static_cast<float>(samples_ * samples_);
    for (std::size_t y = 0; y < out.height; ++y)
        for (std::size_t x = 0; x < out.width; ++x)
            for (std::size_t channel = 0; channel < 3; ++channel) {
                std::uint32_t sum = 0;
                for (std::size_t sy = 0; sy < samples_; ++sy)
                    for (std::size_t sx = 0; sx < samples_; ++sx) {
                        const std::uint32_t v = color_[(y * samples_ + sy) * width_ + x * samples_ + sx][channel];
                        sum += v * v;
                    }
                out.pixels.push_back(to_srgb(static_cast<float>(sum) / full));
            }
    return out;
}

}  // namespace meniscus::cli
