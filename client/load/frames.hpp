// The particle frames that every simulator sends, over and over again.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/particles/particles.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus::load {

/// Generated or read before the clock starts; shared by all simulators.
class Frames {
public:
    /// Moving water: sixteen frames, one period of its wave.
    static Frames moving_water(std::size_t particles, double particle_radius);
    /// Reads any particle file that `meniscus` reads. Throws InvalidInput.
    static Frames read(const std::vector<std::string>& paths);

    /// The positions are borrowed from this object.
    ParticleFrame at(std::uint64_t frame) const;

private:
    std::vector<formats::Particles> frames_;
};

}  // namespace meniscus::load
