// The time of each kernel of a frame.
#pragma once

#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::benchmarks {

/// Prints a line for each kernel of a warm frame: the time of all its launches on the GPU (median of `runs`), how many
/// they are, and what share of the frame. Frames run without graphs. Throws InvalidInput in a build without CUDA.
void print_kernel_times(const ParticleFrame& frame, const Settings& settings, unsigned runs);

}  // namespace meniscus::benchmarks
