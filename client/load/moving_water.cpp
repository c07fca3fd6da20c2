#include "load/moving_water.hpp"

#include <cmath>
#include <numbers>

namespace meniscus::load {

std::vector<float> moving_water(std::size_t particles, double particle_radius, double phase) {
    constexpr double waves = 3.0;
    constexpr double wave_height = 0.15;  // of the block's
    const auto side = static_cast<std::size_t>(std::ceil(std::cbrt(2.0 * static_cast<double>(particles))));
    const double spacing = 2.0 * particle_radius;
    std::vector<float> positions;
    positions.reserve(3 * particles);
    for (std::size_t i = 0; i < particles; ++i) {
        const std::size_t row = i / side;
        const std::size_t layer = row / side;
        const auto x = static_cast<double>(i % side);
        const auto z = static_cast<double>(row % side);
        const auto y = static_cast<double>(layer);
        const double angle = 2.0 * std::numbers::pi * (waves * x / static_cast<double>(side) - phase);
        const double height =
            1.0 + wave_height * std::sin(angle) * std::cos(0.5 * angle + z / static_cast<double>(side));
        for (const double value : {x, y * height, z}) positions.push_back(static_cast<float>(spacing * value));
    }
    return positions;
}

}  // namespace meniscus::load
