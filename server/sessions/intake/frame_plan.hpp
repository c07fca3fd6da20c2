// Which of a frame's bytes are kept, and where.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "conversion/particle_arrays.hpp"
#include "meniscus/settings.hpp"
#include "sessions/intake/input_frame.hpp"

namespace meniscus::server {

struct FramePlan {
    /// The bytes of one array as they arrive.
    struct Piece {
        std::size_t begin = 0;  ///< among all that arrive
        std::size_t end = 0;
        bool kept = false;
        std::size_t place = 0;  ///< in InputFrame::bytes, if they are kept
    };
    std::vector<Piece> pieces;  ///< one behind the other, none of them empty
    std::vector<InputFrame::KeptArray> arrays;
    std::size_t bytes = 0;  ///< of InputFrame::bytes
};

/// The arrays of which a session with these settings makes attributes, in the order in which they arrive. Throws
/// InvalidInput, with its name, for one that no attribute can be made of, and for one that a frame with particles
/// lacks.
std::vector<conversion::FurtherArray> arrays_to_keep(const conversion::ParticleLayout& layout,
                                                     std::uint64_t particle_count, const Settings& settings);

/// The most bytes per particle that such a frame takes here.
std::uint64_t kept_bytes_per_particle(const conversion::ParticleLayout& layout,
                                      const std::vector<conversion::FurtherArray>& kept);

/// count: of particles, small enough that all of the frame's bytes can be counted.
FramePlan plan_frame(const conversion::ParticleLayout& layout, const std::vector<conversion::FurtherArray>& kept,
                     std::size_t count);

}  // namespace meniscus::server
