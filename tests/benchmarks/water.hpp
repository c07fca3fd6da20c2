// Water of any amount whose surface grows with it: basins side by side.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace meniscus::benchmarks {

enum class WaterKind {
    splashing,  ///< half of it a jittered block, half of it drops, threads and sheets in the air
    calm,       ///< a block at rest with low waves
};
constexpr std::string_view name_of(WaterKind kind) {
    switch (kind) {
        case WaterKind::splashing:
            return "splashing";
        case WaterKind::calm:
            return "calm";
    }
    return {};
}

/// Particles of one basin.
inline constexpr std::size_t basin_particles = 16000;

/// x y z per particle, y up, particles two radii apart: as many full basins as `particles` fill, at least one, next to
/// each other in x and z and apart by a kernel's support at smoothing length 2. No two are alike; the same call gives
/// the same positions.
std::vector<float> make_water(WaterKind kind, std::size_t particles, float particle_radius);

/// The same from one particle on: fewer than a basin are those over a square corner of it, about as many.
std::vector<float> make_any_water(WaterKind kind, std::size_t particles, float particle_radius);

}  // namespace meniscus::benchmarks
