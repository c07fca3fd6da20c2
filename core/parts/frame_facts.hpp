// What all processes must know of each one's particles.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "meniscus/part.hpp"
#include "particles/placed_frame.hpp"
#include "parts/brick_loads.hpp"
#include "parts/part_particles.hpp"

namespace meniscus {

struct FrameFacts {
    FrameForm form;
    ParticlesByLevel by_level{};
    std::vector<BrickLoad> loads;  ///< particles, and the surface that the process has made in the last frame
    std::vector<ArrayRange> ranges;

    std::uint64_t particles() const { return std::accumulate(by_level.begin(), by_level.end(), std::uint64_t{0}); }
    unsigned coarsest_level() const {
        unsigned level = max_particle_level;
        while (level > 0 && by_level[level] == 0) --level;
        return level;
    }
};

PartExchange::Bytes packed(const FrameFacts& facts);
/// The facts of all of a frame's particles. Throws InvalidInput where processes with particles bring different arrays
/// or encodings.
FrameFacts facts_together(const std::vector<PartExchange::Bytes>& of_ranks);

}  // namespace meniscus
