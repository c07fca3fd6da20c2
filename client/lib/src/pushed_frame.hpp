// A frame that was pushed and not yet answered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "byte_pool.hpp"
#include "meniscus/client/particle_buffer.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/strided_positions.hpp"
#include "named_arrays.hpp"

namespace meniscus::client {

struct PushedFrame {
    std::uint64_t index = 0;
    std::string begin;                              ///< the request that begins it, serialized
    std::shared_ptr<const void> memory;             ///< of the parts; none once they will not be sent again
    std::vector<std::span<const std::byte>> parts;  ///< the frame's bytes, one part after the other
};

/// Copies the particles, which the caller may change afterwards, and those of the further arrays that are named. Throws
/// InvalidInput for arrays that do not fit each other, and as NamedArrays::of(); LimitExceeded for more particles than
/// can be numbered.
PushedFrame copy_frame(const ParticleFrame& frame, const NamedArrays& named, std::uint64_t index,
                       double simulation_time, BytePool& pool);

/// Likewise; float64 positions are rounded. Throws InvalidInput for one that cannot be.
PushedFrame copy_frame(const StridedPositions& positions, std::span<const std::uint8_t> levels,
                       std::span<const ParticleArray> arrays, const NamedArrays& named, std::uint64_t index,
                       double simulation_time, BytePool& pool);

/// Takes the buffer's memory over. Throws InvalidInput for a buffer that was taken before, and as copy_frame(); the
/// buffer is then as it was.
PushedFrame take_frame(ParticleBuffer& buffer, const NamedArrays& named, std::uint64_t index, double simulation_time);

}  // namespace meniscus::client
