#include "water.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace meniscus::benchmarks {
namespace {

// Lengths in rest distances (two radii) until the particle is stored.
constexpr std::size_t side = 40;  ///< edge of a basin
constexpr std::size_t calm_layers = basin_particles / (side * side);
constexpr std::size_t splashing_layers = calm_layers / 2;
constexpr float gap = 2.0F;        ///< between basins
constexpr float drop_room = 8.0F;  ///< a drop has a cube of this edge to itself
constexpr int drop_reach = 3;      ///< a drop's longest half axis, rounded down

/// -1 to 1, the same numbers with every standard library.
class Noise {
public:
    explicit Noise(std::uint32_t seed) : random_(seed) {}
    float operator()() { return static_cast<float>(random_() >> 8) * 0x1p-23F - 1.0F; }

private:
    std::mt19937 random_;
};

class Basin {
public:
    Basin(std::vector<float>& positions, float distance, float x, float z, std::uint32_t seed)
        : positions_(positions), distance_(distance), x_(x), z_(z), noise_(seed) {}

    void fill(WaterKind kind) {
        switch (kind) {
            case WaterKind::splashing:
                return add_splash();
            case WaterKind::calm:
                return add_calm_block();
        }
    }

private:
    void add(float x, float y, float z, float jitter) {
        for (const float value : {x_ + x, y, z_ + z}) positions_.push_back((value + jitter * noise_()) * distance_);
    }

    void add_calm_block() {
        constexpr float wave_height = 0.25F;
        constexpr std::size_t wave_length = side / 2;
        constexpr auto wave_number = 2.0F * std::numbers::pi_v<float> / static_cast<float>(wave_length);
        const float phase = std::numbers::pi_v<float> * noise_();
        for (std::size_t i = 0; i < basin_particles; ++i) {
            const auto x = static_cast<float>(i % side);
            const std::size_t row = i / side % side;
            const std::size_t layer = i / (side * side);
            const auto z = static_cast<float>(row);
            const auto y = static_cast<float>(layer);
            const float wave = std::sin(wave_number * x + phase) * std::cos(wave_number * z);
            add(x, y * (1.0F + wave_height / static_cast<float>(calm_layers) * wave), z, 0.03F);
        }
    }

    void add_splash() {
        const std::size_t end = positions_.size() + 3 * basin_particles;
        for (std::size_t i = 0; i < side * side * splashing_layers; ++i) {
            const std::size_t row = i / side % side;
            const std::size_t layer = i / (side * side);
            add(static_cast<float>(i % side), static_cast<float>(layer), static_cast<float>(row), 0.3F);
        }
        constexpr auto rooms = static_cast<std::size_t>(static_cast<float>(side) / drop_room);
        for (std::size_t i = 0; positions_.size() < end; ++i) {
            const std::size_t row = i / rooms % rooms;
            const std::size_t layer = i / (rooms * rooms);
            add_drop((0.5F + static_cast<float>(i % rooms)) * drop_room,
                     static_cast<float>(splashing_layers) + (0.5F + static_cast<float>(layer)) * drop_room,
                     (0.5F + static_cast<float>(row)) * drop_room, end);
        }
    }

    /// An ellipsoid: a drop, a thread or a sheet. end: what `positions_` holds at most.
    void add_drop(float x, float y, float z, std::size_t end) {
        std::array<float, 3> half{};
        for (float& h : half) h = 2.1F + 1.5F * noise_();
        for (int i = -drop_reach; i <= drop_reach; ++i)
            for (int j = -drop_reach; j <= drop_reach; ++j)
                for (int k = -drop_reach; k <= drop_reach; ++k) {
                    const float u = static_cast<float>(i) / half[0];
                    const float v = static_cast<float>(j) / half[1];
                    const float w = static_cast<float>(k) / half[2];
                    if (u * u + v * v + w * w <= 1.0F && positions_.size() < end)
                        add(x + static_cast<float>(i), y + static_cast<float>(j), z + static_cast<float>(k), 0.3F);
                }
    }

    std::vector<float>& positions_;
    float distance_;
    float x_;
    float z_;
    Noise noise_;
};

}  // namespace

std::vector<float> make_water(WaterKind kind, std::size_t particles, float particle_radius) {
    const std::size_t basins = std::max<std::size_t>(1, particles / basin_particles);
    const auto along_x = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(basins))));
    constexpr float pitch = static_cast<float>(side) + gap;
    std::vector<float> positions;
    positions.reserve(3 * basins * basin_particles);
    for (std::size_t i = 0; i < basins; ++i) {
        const std::size_t row = i / along_x;
        Basin(positions, 2.0F * particle_radius, pitch * static_cast<float>(i % along_x),
              pitch * static_cast<float>(row), static_cast<std::uint32_t>(i + 1))
            .fill(kind);
    }
    return positions;
}

std::vector<float> make_any_water(WaterKind kind, std::size_t particles, float particle_radius) {
    std::vector<float> water = make_water(kind, particles, particle_radius);
    if (particles >= basin_particles) return water;
    const float share = std::sqrt(static_cast<float>(particles) / static_cast<float>(basin_particles));
    const float edge = share * static_cast<float>(side) * 2.0F * particle_radius;
    std::vector<float> corner;
    for (std::size_t i = 0; i < water.size(); i += 3)
        if (water[i] < edge && water[i + 2] < edge) corner.insert(corner.end(), {water[i], water[i + 1], water[i + 2]});
    return corner;
}

}  // namespace meniscus::benchmarks
