// The file format of recordings: DIR/SESSION/000001.recording. SESSION is the session's UUID. The number rises with
// each time that the session began anew, or that its frame indices did (a new stream): within a file they rise.
//
// A file is `recording_magic`, then entries: meniscus.v1.RecordingEntry messages, each after its length in bytes as a
// protobuf varint (protobuf's usual "delimited" framing). The first is `begin`. An entry `particles` or `mesh` says how
// many bytes of messages follow it, delimited in the same way, before the next entry: those of the frame as they
// travel, StreamRequest (frame_begin, frame_chunk of at most 1 MiB each, frame_end) or StreamResponse (a `.bricks` file
// of its own). So frames are found by hopping from entry to entry, and nothing of a frame is read but what is asked
// for.
//
// Numbers are protobuf's, particle data as FrameChunk has it: little-endian. Files only ever grow at their ends. One
// that a crash or a full disk has cut ends within a frame: readers leave that tail out. While a file is being written
// its writer holds a lock: see writing_mark.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace meniscus::files {

inline constexpr std::string_view recording_magic = "Meniscus recording\n";
inline constexpr std::string_view recording_extension = ".recording";
inline constexpr std::uint32_t recording_version = 1;
/// An entry alone, without the messages that follow it: beyond this it is none.
inline constexpr std::size_t max_recording_entry_bytes = 4096;
/// One of the messages that follow: a chunk or a part of a brick of 1 MiB, and room for what is beside it.
inline constexpr std::size_t max_recorded_message_bytes = std::size_t{2} << 20;

}  // namespace meniscus::files
