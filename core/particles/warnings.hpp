// The warnings of a frame that has been reconstructed. The rules look at the frame, the settings and figures that are
// the same on every backend, and so are they.
#pragma once

#include <functional>
#include <string>

#include "meniscus/settings.hpp"
#include "meniscus/statistics.hpp"
#include "particles/placed_frame.hpp"

namespace meniscus {

/// Fills statistics.warnings, in the order of their codes; the other figures are there. The frame is valid.
/// greatest_sample: the greatest value of the field that was sampled; asked for only where the surface is empty. Of
/// particles that are on the GPU, the radius is not held against their spacing, which would take them to the host.
void find_warnings(const PlacedFrame& particles, const ParticlesByLevel& by_level, const Settings& settings,
                   const std::function<float()>& greatest_sample, Statistics& statistics);

/// For a refusal of the frame, after its last word: the radius that fits the particles' spacing; empty where none is
/// known.
std::string fitting_radius_hint(const PlacedFrame& particles, const Settings& settings);

}  // namespace meniscus
