// Encoded bricks as a file, `.bricks`: what a server sends for one frame, kept as it came.
//
// A sequence of meniscus.v1.StreamResponse messages, each after its length in bytes as a protobuf varint (protobuf's
// usual "delimited" framing): one with mesh_begin, then one or more with mesh_brick for each of its bricks (a brick of
// more than 1 MiB in parts), then one with frame_statistics. Several frames may follow each other; the reader takes the
// first.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "meniscus/client/client.hpp"

namespace meniscus::formats {

/// Writes one frame. Atomic. Throws InvalidInput if the path cannot be written.
void write_bricks(const std::filesystem::path& path, const client::ReceivedFrame& frame);

/// Reads the first frame. Throws InvalidInput, in one line that names the file, for anything else.
client::ReceivedFrame read_bricks(const std::string& name, std::string_view bytes);

/// A mesh reconstructed here, encoded as a server would.
client::ReceivedFrame encode_frame(const Mesh& mesh, const Statistics& statistics, std::uint64_t index,
                                   double simulation_time, const CodingOptions& options = {});

}  // namespace meniscus::formats
