// A frame's particles as they go out to watchers.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sessions/intake/input_frame.hpp"
#include "sessions/sending/encoded_frame.hpp"

namespace meniscus::server {

/// Immutable, shared by all receivers.
struct ParticleMessages {
    std::chrono::steady_clock::time_point received_at;  ///< the last byte of the particles
    std::vector<SharedMessage> messages;  ///< WatchParticlesResponses in protobuf's wire format, in their order
    std::size_t bytes = 0;                ///< of them
};

/// The smallest stride that sends no more than max_particles of `count` particles; 1 if max_particles is 0.
std::uint64_t stride_for(std::uint64_t count, std::uint64_t max_particles);

/// Positions that came quantized go out as they came; others are quantized over the box of those that are sent. All are
/// finite. particle_radius: of level 0, world units. stride: of stride_for().
ParticleMessages encode_particles(const InputFrame& frame, std::uint64_t run_id, double particle_radius,
                                  std::uint64_t stride);

}  // namespace meniscus::server
