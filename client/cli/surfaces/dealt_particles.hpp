// The particles of a frame that one of several uploaders sends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "meniscus/particle_frame.hpp"

namespace meniscus::cli {

/// Every parts-th particle of the frame, beginning with the part-th, counted from 0.
class DealtParticles {
public:
    /// The frame may go afterwards, but for the names of its arrays. Its positions are not quantized.
    DealtParticles(const ParticleFrame& frame, std::uint32_t part, std::uint32_t parts);
    DealtParticles(const DealtParticles&) = delete;
    DealtParticles& operator=(const DealtParticles&) = delete;

    ParticleFrame frame() const;

private:
    std::vector<float> positions_;
    std::vector<std::uint8_t> levels_;
    std::vector<std::vector<std::byte>> values_;
    std::vector<ParticleArray> arrays_;  ///< of them
};

}  // namespace meniscus::cli
