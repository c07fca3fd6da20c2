// A frame, the memory in which its arrays lie, and the numbers that vertices get from them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "lattice/lattice_part.hpp"
#include "meniscus/particle_frame.hpp"
#include "particles/attributes.hpp"

namespace meniscus {

struct PlacedFrame {
    PlacedFrame(const ParticleFrame& in_host_memory) : frame(in_host_memory) {}
    PlacedFrame(const ParticleFrame& f, bool is_on_device) : frame(f), on_device(is_on_device) {}

    ParticleFrame frame;  ///< the frame, with those arrays alone that become attributes
    AttributeNumbers attributes;
    LatticePart part;        ///< the whole, or the part of a frame that is made of these particles
    bool on_device = false;  ///< whether its spans are of device pointers, which the host must not follow
    bool is_last = false;    ///< whether no other follows, so that memory that no later step needs can be given back
};

/// Number of particles of each level.
using ParticlesByLevel = std::array<std::uint64_t, max_particle_level + 1>;

/// Counts them in a frame in host memory.
inline ParticlesByLevel count_levels(const ParticleFrame& frame) {
    ParticlesByLevel particles{frame.count()};
    for (unsigned level = 1; level <= max_particle_level && !frame.levels.empty(); ++level) {
        const auto of_level = std::count(frame.levels.begin(), frame.levels.end(), static_cast<std::uint8_t>(level));
        particles[level] = static_cast<std::uint64_t>(of_level);
        particles[0] -= particles[level];
    }
    return particles;
}

/// A particle of level k stands for a cube of twice its radius: 8^k times that of level 0. World units cubed.
inline double volume_of(const ParticlesByLevel& particles, const Settings& settings) {
    std::uint64_t cubes = 0;
    for (unsigned level = 0; level <= max_particle_level; ++level) cubes += particles[level] << (3 * level);
    const double edge = 2.0 * settings.particle_radius;
    return static_cast<double>(cubes) * (edge * edge * edge);
}

}  // namespace meniscus
