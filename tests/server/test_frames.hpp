// Particle frames for tests: made, not stored.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "meniscus/mesh_hash.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/reconstructor.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::server::test {

inline constexpr double radius = 0.1;

inline Settings settings() {
    Settings settings;
    settings.particle_radius = radius;
    settings.cell_size = 1.0;
    return settings;
}

/// Owns what a ParticleFrame borrows.
struct Particles {
    std::vector<float> positions;
    std::vector<std::uint16_t> quantized;
    Box box;
    std::vector<std::uint8_t> levels;

    ParticleFrame view() const {
        return {.positions = positions, .quantized = quantized, .quantization_box = box, .levels = levels};
    }
};

/// A block of side^3 particles whose top is a wave; `phase` makes frames differ.
inline Particles wave(std::size_t side, double phase) {
    Particles particles;
    for (std::size_t z = 0; z < side; ++z)
        for (std::size_t y = 0; y < side; ++y)
            for (std::size_t x = 0; x < side; ++x) {
                const double spacing = 2.0 * radius;
                const double height = 1.0 + 0.3 * std::sin(phase + 0.7 * static_cast<double>(x));
                particles.positions.push_back(static_cast<float>(spacing * static_cast<double>(x)));
                particles.positions.push_back(static_cast<float>(spacing * height * static_cast<double>(y)));
                particles.positions.push_back(static_cast<float>(spacing * static_cast<double>(z)));
            }
    return particles;
}

/// Particles apart from each other: every one gives a drop of its own, so that the mesh is large.
inline Particles spray(std::size_t side) {
    Particles particles;
    for (std::size_t z = 0; z < side; ++z)
        for (std::size_t y = 0; y < side; ++y)
            for (std::size_t x = 0; x < side; ++x)
                for (const std::size_t i : {x, y, z})
                    particles.positions.push_back(static_cast<float>(
                        (12.3 * static_cast<double>(i) + 0.01 * static_cast<double>(x * y)) * radius));
    return particles;
}

/// The particles quantized, as three uint16 each.
inline Particles quantized(const Particles& particles) {
    Particles result;
    result.box = {.min = {-1.0, -1.0, -1.0}, .max = {9.0, 9.0, 9.0}};
    for (const float p : particles.positions)
        result.quantized.push_back(static_cast<std::uint16_t>(std::lround((p + 1.0) / 10.0 * 65535.0)));
    return result;
}

/// The SHA-256 of the mesh that the server must return for this frame.
inline std::string local_sha256(const Particles& particles) {
    Reconstructor reconstructor(settings(), {.threads = 1});
    Mesh mesh;
    reconstructor.reconstruct(particles.view(), mesh);
    return mesh_sha256(mesh);
}

}  // namespace meniscus::server::test
