// The warnings of a frame that has been reconstructed. The rules look at the frame, the settings and figures that are
// the same on every backend, and so are they.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "meniscus/settings.hpp"
#include "meniscus/statistics.hpp"
#include "particles/placed_frame.hpp"

namespace meniscus {

/// The warning that a frame's radius does not fit the spacing of its particles. It goes through all of them, and needs
/// no figure: it may run beside the reconstruction. The frame is valid. None for particles that are on the GPU, which
/// it would take to the host.
std::optional<Warning> find_wrong_radius(const PlacedFrame& particles, const Settings& settings);

/// Fills statistics.warnings, in the order of their codes; the other figures are there. The frame is valid.
/// wrong_radius: of find_wrong_radius(). greatest_sample: the greatest value of the field that was sampled; asked for
/// only where the surface is empty.
void find_warnings(const PlacedFrame& particles, const ParticlesByLevel& by_level, const Settings& settings,
                   std::optional<Warning> wrong_radius, const std::function<float()>& greatest_sample,
                   Statistics& statistics);

/// For a refusal of the frame, after its last word: the radius that fits the particles' spacing; empty where none is
/// known.
std::string fitting_radius_hint(const PlacedFrame& particles, const Settings& settings);

}  // namespace meniscus
