// Particle frames for tests, the same on every run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "meniscus/mesh.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::test {

/// Owns the arrays that a ParticleFrame borrows.
struct Particles {
    std::vector<float> positions;
    std::vector<std::uint8_t> levels;

    void add(float x, float y, float z) {
        for (const float coordinate : {x, y, z}) positions.push_back(coordinate);
    }
    std::size_t count() const { return positions.size() / 3; }
    ParticleFrame frame() const;
};

/// The mesh of a frame on the CPU, by a reconstructor of its own.
Mesh reconstruct(const Settings& settings, const ParticleFrame& frame, unsigned threads = 1);

/// Radius 0.025 and the defaults.
Settings default_settings();

/// A jittered block of water (spacing 2 r) with drops flying off it: every feature of a splash in few particles.
Particles splash(unsigned seed, int side = 12, float radius = 0.025F);

/// Inputs that a reconstruction meets rarely: by name, for SCOPED_TRACE.
struct NamedParticles {
    std::string name;
    Particles particles;
};
std::vector<NamedParticles> adversarial(float radius);

}  // namespace meniscus::test
