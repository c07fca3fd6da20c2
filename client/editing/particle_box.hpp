// The particles of a part of space.
#pragma once

#include "formats/particles/particles.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::editing {

/// Leaves out the particles outside of the box, with all that they carry; its border belongs to it. The others keep
/// their order. Particles without a finite place stay, for the check that refuses them.
void keep_inside(formats::Particles& particles, const Box& box);

}  // namespace meniscus::editing
