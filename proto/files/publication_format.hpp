// The file format of publications: frames of a surface as plain files, which any web host, cache or CDN carries.
//
// A publication is a folder of segments, which never change, and `manifest.json`, which alone does. The manifest is a
// meniscus.v1.Publication in protobuf's JSON. A segment is named by the SHA-256 of its bytes.
//
// A segment is `segment_magic`, then protobuf messages, each after its length in bytes as a protobuf varint: a
// meniscus.v1.SegmentBegin, which is the index of its frames, then the frames, each as a watcher is sent it
// (meniscus.v1.WatchResponse): mesh_begin, mesh_bricks, spray_points, frame_statistics. The first frame is whole; the
// others may be differences to the frame before. A segment ends after about a second or a MiB, and has at least one
// frame; it can be read without any other.
//
// Writers make a segment first, and name it in the manifest afterwards; both appear whole or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace meniscus::files {

inline constexpr std::string_view publication_format = "Meniscus publication";
inline constexpr std::uint32_t publication_version = 1;
inline constexpr std::string_view manifest_name = "manifest.json";
inline constexpr std::string_view segment_magic = "Meniscus segment\n";
inline constexpr std::uint32_t segment_version = 1;
inline constexpr std::string_view segment_extension = ".segment";
/// Most bytes of a manifest that a reader takes.
inline constexpr std::size_t max_manifest_bytes = std::size_t{64} << 20;
/// Most segments that a writer lists, with which the manifest stays below that. A session makes one a second: 47 hours.
inline constexpr std::size_t max_segments = 170'000;
/// Most bytes of a segment, which protobuf's streams count in 31 bits.
inline constexpr std::size_t max_segment_bytes = (std::size_t{1} << 31) - 1;
/// A frame is shown this long, in seconds, where no clock has run while it was made.
inline constexpr double published_frame_seconds = 0.04;

}  // namespace meniscus::files
