// Frames of water that moves.
#pragma once

#include <vector>

#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::benchmarks {

/// x y z per particle, for each frame.
using Frames = std::vector<std::vector<float>>;

/// The water moves by a fraction of a cell from frame to frame, so that no brick is ever the same again.
inline Frames moving(const std::vector<float>& water, const Settings& settings, unsigned count) {
    Frames frames(count, water);
    const double step = 0.37 * settings.cell_size * settings.particle_radius;
    for (unsigned i = 0; i < count; ++i)
        for (float& coordinate : frames[i]) coordinate += static_cast<float>(i * step);
    return frames;
}

inline ParticleFrame frame_of(const std::vector<float>& positions) {
    ParticleFrame frame;
    frame.positions = positions;
    return frame;
}

}  // namespace meniscus::benchmarks
