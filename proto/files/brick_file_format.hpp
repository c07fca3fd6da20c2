// The file format of encoded meshes, `.bricks`: what a server sends for one frame, kept as it came.
//
// A file is `brick_file_magic`, then protobuf messages, each after its length in bytes as a protobuf varint (protobuf's
// usual "delimited" framing): a meniscus.v1.BrickFileBegin; then meniscus.v1.StreamResponse messages: one with
// mesh_begin, one or more with mesh_brick for each brick (a brick of more than 1 MiB in parts), any with spray_points,
// one with frame_statistics. Several frames may follow each other; readers of files take the first, `meniscus push` all
// of them, and what follows behind a further magic.
//
// The version rises with a change that an earlier reader would misunderstand. Readers skip fields of messages that they
// do not know, so new fields do not raise it. Version 1 had neither magic nor BrickFileBegin, and its bricks named no
// codec; it is not read any more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace meniscus::files {

inline constexpr std::string_view brick_file_magic = "Meniscus bricks\n";
inline constexpr std::uint32_t brick_file_version = 2;

}  // namespace meniscus::files
