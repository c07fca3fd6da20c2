// Frames whose particles carry something, and the same frames in another order.
#pragma once

#include <cstdint>
#include <cstring>
#include <numeric>
#include <random>
#include <vector>

#include "meniscus/particle_frame.hpp"
#include "support/particles.hpp"

namespace meniscus::test {

/// A velocity and a phase for each particle. Owns the arrays that frame() borrows.
struct ParticlesWithPayload {
    Particles particles;
    std::vector<float> velocities;     ///< three for each
    std::vector<std::uint8_t> phases;  ///< one for each
    std::vector<ParticleArray> arrays;

    ParticleFrame frame() {
        arrays = {{"velocity", std::as_bytes(std::span(velocities)), ElementType::float32, 3},
                  {"phase", std::as_bytes(std::span(phases)), ElementType::uint8, 1}};
        ParticleFrame f = particles.frame();
        f.arrays = arrays;
        return f;
    }
    /// All that a particle carries, as bytes.
    std::vector<std::byte> payload_of(std::uint32_t i) const {
        std::vector<std::byte> bytes(13);
        std::memcpy(bytes.data(), velocities.data() + 3 * std::size_t{i}, 12);
        bytes[12] = static_cast<std::byte>(phases[i]);
        return bytes;
    }
    ParticlesWithPayload in_order(const std::vector<std::uint32_t>& order) const {
        ParticlesWithPayload other;
        for (const std::uint32_t i : order) {
            other.particles.add(particles.positions[3 * i], particles.positions[3 * i + 1],
                                particles.positions[3 * i + 2]);
            if (!particles.levels.empty()) other.particles.levels.push_back(particles.levels[i]);
            for (std::size_t axis = 0; axis < 3; ++axis) other.velocities.push_back(velocities[3 * i + axis]);
            other.phases.push_back(phases[i]);
        }
        return other;
    }
    ParticlesWithPayload shuffled(unsigned seed) const {
        std::vector<std::uint32_t> order(particles.count());
        std::iota(order.begin(), order.end(), 0U);
        std::shuffle(order.begin(), order.end(), std::mt19937(seed));
        return in_order(order);
    }
};

/// A splash of which many particles lie at one place, some of those with the same payload.
inline ParticlesWithPayload crowded_places(bool levels) {
    ParticlesWithPayload p;
    p.particles = splash(11, 5);
    for (std::size_t i = 0, n = p.particles.count(); i < n; i += 3)
        for (int copy = 0; copy < 1 + static_cast<int>(i % 40); ++copy)
            p.particles.add(p.particles.positions[3 * i], p.particles.positions[3 * i + 1],
                            p.particles.positions[3 * i + 2]);
    std::mt19937 random(5);
    for (std::size_t i = 0; i < p.particles.count(); ++i) {
        for (int axis = 0; axis < 3; ++axis) p.velocities.push_back(static_cast<float>(random() % 3) - 1.0F);
        p.phases.push_back(static_cast<std::uint8_t>(random() % 4));
        if (levels) p.particles.levels.push_back(static_cast<std::uint8_t>(random() % 2));
    }
    return p;
}

}  // namespace meniscus::test
