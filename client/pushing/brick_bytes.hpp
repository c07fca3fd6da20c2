// Frames of finished bricks as the bytes of a `.bricks` file, for `meniscus push`, written without Protocol Buffers.
// proto/files/brick_file_format.hpp describes them.
#pragma once

#include <string>
#include <vector>

#include "meniscus/client/received_frame.hpp"
#include "pushing/frame_bytes.hpp"

namespace meniscus::pushing {

/// What a file of bricks begins with.
std::string bricks_beginning();

/// The bytes of a frame whose bricks are of a lattice codec, piece by piece; they borrow from the frame.
std::vector<FramePiece> brick_pieces(const client::ReceivedFrame& frame);

}  // namespace meniscus::pushing
