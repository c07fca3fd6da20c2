// A frame that was pushed and not yet answered.
#pragma once

#include <cstdint>
#include <memory>

#include "byte_pool.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::client {

struct PushedFrame {
    v1::FrameBegin begin;
    std::shared_ptr<Bytes> bytes;  ///< of the arrays, one after the other; none once they will not be sent again
};

/// Copies the particles, which the caller may change afterwards. Throws InvalidInput for a frame with further arrays.
PushedFrame copy_frame(const ParticleFrame& frame, std::uint64_t index, double simulation_time, BytePool& pool);

}  // namespace meniscus::client
