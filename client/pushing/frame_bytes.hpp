// Frames of particles as the bytes of a recording, for `meniscus push`, written without Protocol Buffers.
// proto/files/recording_format.hpp describes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "meniscus/particle_frame.hpp"

namespace meniscus::pushing {

/// What a recording begins with; it leaves the settings to its reader.
std::string recording_beginning();

/// A piece of a frame's bytes: `head`, then `data`, which is the caller's.
struct FramePiece {
    std::string head;
    std::span<const std::byte> data;
};

/// The bytes of a frame of float32 positions, piece by piece; they borrow from the frame.
std::vector<FramePiece> frame_pieces(const ParticleFrame& frame, std::uint64_t index, double simulation_time);

}  // namespace meniscus::pushing
