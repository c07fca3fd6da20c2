// Moving water of a given number of particles, as cheap to generate as to send.
#pragma once

#include <cstddef>
#include <vector>

namespace meniscus::load {

/// x y z per particle: a block with a spacing of two radii, half as high as wide, whose top is a wave along x.
/// phase: the elapsed part of the wave's period, 0 to 1.
std::vector<float> moving_water(std::size_t particles, double particle_radius, double phase);

}  // namespace meniscus::load
