#include "picture/shading.hpp"

namespace meniscus::cli {
namespace {

using Direction = std::array<float, 3>;

float dot(const Direction& a, const Direction& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Direction normalized(const Direction& d) {
    const float length = std::sqrt(dot(d, d));
    return {d[0] / length, d[1] / length, d[2] / length};
}

Color mix(const Color& a, const Color& b, float t) {
    return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

struct Light {
    Direction towards;
    Color color;
    float sharpness;  ///< exponent of its highlight
};

}  // namespace

Color water(const Direction& normal, const Direction& up) {
    static const std::array<Light, 2> lights{{{normalized({-0.5F, 0.8F, 0.7F}), {0.75F, 0.74F, 0.70F}, 60.0F},
                                              {normalized({0.9F, 0.2F, 0.5F}), {0.16F, 0.20F, 0.26F}, 20.0F}}};
    constexpr Color deep{0.006F, 0.060F, 0.18F};
    constexpr Color shallow{0.035F, 0.22F, 0.48F};
    constexpr Color sky{0.70F, 0.86F, 1.0F};
    const Color body = mix(deep, shallow, 0.5F + 0.5F * dot(normal, up));
    Color color{0.35F * body[0], 0.35F * body[1], 0.35F * body[2]};
    for (const Light& light : lights) {
        const float diffuse = std::max(0.0F, dot(normal, light.towards));
        const Direction halfway = normalized({light.towards[0], light.towards[1], light.towards[2] + 1.0F});
        const float highlight = 0.6F * std::pow(std::max(0.0F, dot(normal, halfway)), light.sharpness);
        for (std::size_t i = 0; i < 3; ++i) color[i] += light.color[i] * (1.1F * body[i] * diffuse + highlight);
    }
    // Schlick's approximation of how much of the sky a water surface mirrors at a grazing angle.
    const float grazing = 1.0F - std::clamp(normal[2], 0.0F, 1.0F);
    const float mirrored = 0.02F + 0.55F * grazing * grazing * grazing * grazing;
    return mix(color, sky, mirrored);
}

Color colored(const std::array<float, 3>& rgb, const Direction& normal) {
    static const Direction towards = normalized({-0.5F, 0.8F, 0.7F});
    static const Direction halfway = normalized({towards[0], towards[1], towards[2] + 1.0F});
    const float facing = std::clamp(normal[2], 0.0F, 1.0F);
    const float light = 0.55F + 0.3F * (0.5F + 0.5F * dot(normal, towards)) + 0.2F * facing;
    const float highlight = 0.22F * std::pow(std::max(0.0F, dot(normal, halfway)), 48.0F);
    Color linear{};
    for (std::size_t i = 0; i < 3; ++i) {
        const float v = std::clamp(rgb[i] / 255.0F * light + highlight, 0.0F, 1.0F);
        linear[i] = v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
    }
    return linear;
}

Color wire(std::uint8_t level, float line, float facing) {
    static constexpr std::array<Color, 4> colors{
        {{0.45F, 0.02F, 0.55F}, {0.02F, 0.12F, 0.75F}, {0.01F, 0.38F, 0.05F}, {0.80F, 0.06F, 0.01F}}};
    const Color& pure = colors[std::min<std::size_t>(level, 3)];
    const float shade = 0.45F + 0.55F * std::clamp(facing, 0.0F, 1.0F);
    const Color face = mix({0.95F, 0.95F, 0.95F}, pure, 0.10F);
    const Color shaded_face{face[0] * shade, face[1] * shade, face[2] * shade};
    const Color shaded_line{pure[0] * shade, pure[1] * shade, pure[2] * shade};
    return mix(shaded_face, shaded_line, line);
}

}  // namespace meniscus::cli
