// The particle frames that every simulator sends, over and over.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/particles.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus::load {

/// Made or read before the clock starts; shared by all simulators.
class Frames {
public:
    /// Moving water: sixteen frames, after which its wave has come round.
    static Frames moving_water(std::size_t particles, double particle_radius);
    /// As any file of particles that `meniscus` reads. Throws InvalidInput.
    static Frames read(const std::vector<std::string>& paths);

    /// Borrowed.
    ParticleFrame at(std::uint64_t frame) const;

private:
    std::vector<formats::Particles> frames_;
};

}  // namespace meniscus::load
