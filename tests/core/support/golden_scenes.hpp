// Particles for the golden meshes. Every coordinate is a whole multiple of 2^-12, made with integers alone, so that any
// compiler and any standard library gives the same bits.
#pragma once

#include <string>
#include <vector>

#include "support/particles.hpp"

namespace meniscus::test {

struct GoldenScene {
    std::string name;
    Particles particles;                   ///< positions empty if `quantized` is not
    std::vector<std::uint16_t> quantized;  ///< x y z per particle, over quantization_box
    Box quantization_box;

    ParticleFrame frame() const;
};

/// For a particle radius of golden_radius: "splash", "slab", "drops", "lone", "levels" and "quantized".
std::vector<GoldenScene> golden_scenes();

/// World units.
inline constexpr double golden_radius = 0.025;

}  // namespace meniscus::test
