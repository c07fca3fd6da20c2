// The particles of a process that lie near a part: chosen, and sent.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus {

/// The least and the greatest of the numbers that positions are given in, along each axis.
struct NumberBounds {
    std::array<float, 3> least{}, greatest{};
};

/// Chooses particles of a frame by the places that their positions decode to. Keeps its memory from frame to frame.
class ParticlesNear {
public:
    /// frame: valid; borrowed until the next one begins. settings: of the lattice to which it will be snapped.
    void begin(const ParticleFrame& frame, const Settings& settings);
    /// Those within a closed box, world units, as a message. memory: of a message before.
    std::vector<std::byte> within(const Box& box, std::vector<std::byte> memory);

private:
    /// A position is in the box if its numbers are within these.
    NumberBounds numbers_within(const Box& box) const;
    std::span<const std::uint32_t> places_within(const NumberBounds& box);

    ParticleFrame frame_;
    double units_per_length_ = 0.0;
    NumberBounds all_;
    std::vector<NumberBounds> groups_;  ///< of successive particles: those of a simulation lie together as a rule
    std::vector<std::uint32_t> places_;
};

}  // namespace meniscus
