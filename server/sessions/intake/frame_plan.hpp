// Which of a frame's bytes are kept, and where.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "conversion/particle_arrays.hpp"
#include "meniscus/settings.hpp"
#include "sessions/intake/brick_part.hpp"
#include "sessions/intake/input_frame.hpp"
#include "sessions/limits/limits.hpp"

namespace meniscus::server {

/// What one stream announces of a frame: all of it, or its part.
struct FramePart {
    std::uint64_t index = 0;
    double simulation_time = 0.0;
    std::uint64_t particle_count = 0;
    conversion::ParticleLayout layout;
    std::vector<conversion::FurtherArray> kept;  ///< see arrays_to_keep()
    Box quantization_box;
    std::optional<BrickPart> bricks;  ///< that come in place of particles; none: particles
};

/// The bytes of one array as they arrive over a stream.
struct FramePiece {
    std::size_t begin = 0;  ///< among all that arrive
    std::size_t end = 0;
    bool kept = false;
    std::size_t place = 0;  ///< in InputFrame::bytes, if they are kept
};

/// The arrays of which a session with these settings makes attributes, in the order in which they arrive. Throws
/// InvalidInput, with its name, for one that no attribute can be made of, and for one that a frame with particles
/// lacks.
std::vector<conversion::FurtherArray> arrays_to_keep(const conversion::ParticleLayout& layout,
                                                     std::uint64_t particle_count, const Settings& settings);

/// All bytes of the part, as they arrive. Throws LimitExceeded for more than can be counted.
std::size_t arriving_bytes(const FramePart& part);

/// Begins the frame that consists of these parts, the particles or bricks of one behind those of the part before: gives
/// it memory for all of them. Returns where the bytes of each part go: pieces one behind the other, none of them empty.
/// Throws InvalidInput for parts that do not fit each other, LimitExceeded for a frame past a limit, before it takes
/// memory. parts: of one index, at least one; all of particles, or all of bricks.
std::vector<std::vector<FramePiece>> begin_frame(std::span<const FramePart> parts, const Limits& limits,
                                                 InputFrame& frame);

}  // namespace meniscus::server
