// The file format of recordings: DIR/SESSION/000001.recording. SESSION is the session's UUID. The number rises each
// time that the session is created anew or that its frame indices begin anew (a new stream): within a file they rise.
//
// A file is `recording_magic`, then entries: meniscus.v1.RecordingEntry messages, each after its length in bytes as a
// protobuf varint (protobuf's usual "delimited" framing). The first is `begin`. An entry says how many bytes of
// messages follow it, delimited in the same way, before the next entry. Those of `particles` and `mesh` are the frame
// as it travels: StreamRequest (frame_begin, frame_chunk of at most 1 MiB each, frame_end), or StreamResponse (as in a
// .bricks file: see brick_file_format.hpp). So a reader finds frames by hopping from entry to entry, and reads nothing
// of a frame but what it is asked for.
//
// Each entry ends with a checksum of itself, and has one of the messages that follow it: see recording_checksums.hpp. A
// reader verifies the entries that it hops over, and a frame when it reads it. Older recordings have no checksums.
//
// The version rises with a change that an earlier reader would misunderstand. Readers skip fields of messages, and
// kinds of entries, that they do not know, so new ones do not raise it. Version 1 had frames without a list of arrays
// and bricks without a codec; it is not read any more.
//
// Numbers are protobuf's, particle data as FrameChunk has it: little-endian. Files only ever grow at their ends. A file
// that a crash or a full disk has cut ends within a frame: readers leave that tail out. While a file is being written
// its writer holds a lock: see writing_mark.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace meniscus::files {

inline constexpr std::string_view recording_magic = "Meniscus recording\n";
inline constexpr std::string_view recording_extension = ".recording";
inline constexpr std::uint32_t recording_version = 2;
/// Most bytes of an entry alone, without the messages that follow it.
inline constexpr std::size_t max_recording_entry_bytes = 4096;
/// Most bytes of one of the messages that follow: a chunk or a part of a brick of 1 MiB, and room for its other fields.
inline constexpr std::size_t max_recorded_message_bytes = std::size_t{2} << 20;

}  // namespace meniscus::files
