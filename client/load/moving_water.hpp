// Water that moves: as many particles as asked for, as cheap to make as to send.
#pragma once

#include <cstddef>
#include <vector>

namespace meniscus::load {

/// x y z per particle: a block two radii apart, half as high as wide, whose top is a wave that travels along x.
/// phase: the part of the wave's period that has passed, 0 to 1.
std::vector<float> moving_water(std::size_t particles, double particle_radius, double phase);

}  // namespace meniscus::load
