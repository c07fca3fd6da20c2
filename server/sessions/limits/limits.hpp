// The limits that the server refuses to exceed. 0 means no limit.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "meniscus/described.hpp"
#include "sessions/limits/name_shares.hpp"
#include "sessions/limits/upload_pace.hpp"

namespace meniscus::server {

/// The most bytes of one chunk of particle data, and of one part of a brick.
inline constexpr std::size_t chunk_bytes = std::size_t{1} << 20;
/// Streams that may each send a part of every frame.
inline constexpr std::uint32_t parts_per_frame = 256;
/// The range of Limits::message_bytes: from a full chunk and its envelope to the most that gRPC can count.
inline constexpr std::size_t min_message_bytes = chunk_bytes + 1024;
inline constexpr std::size_t max_message_bytes = std::numeric_limits<int>::max();

/// The part of a limit that the share below leaves.
template <class Number>
constexpr Number an_eighth(Number limit) {
    return limit > 1 ? std::max<Number>(limit / 8, 1) : 0;
}

/// The share of one caller where nothing else is said: others find room beside it.
template <class Number>
constexpr Number all_but_an_eighth(Number limit) {
    return limit - an_eighth(limit);
}

struct Limits {
    std::uint32_t sessions = 16;
    /// The limits of one token's name, or without tokens of one peer address.
    NameShares per_name{};
    std::uint32_t watchers_per_session = 64;
    /// Formats that a session's watchers ask for: each is encoded once for each frame; see WatchForm.
    std::uint32_t formats_per_session = 8;
    /// Snapshots under way at a time, and those of one name.
    std::uint32_t snapshots = 16;
    std::uint32_t snapshots_per_name = 8;
    /// Connections to the gRPC port, as far as the process's descriptors are enough.
    std::uint32_t connections = 4096;
    /// Connections from one address to one port; not of loopback, Unix sockets and trusted proxies.
    std::uint32_t connections_per_peer = 512;
    /// Calls that read recordings at the same time.
    std::uint32_t recording_readers = 16;
    /// Such a call ends if its client takes no message for this time.
    std::chrono::milliseconds reader_patience{60'000};
    std::uint64_t particles_per_frame = 0;
    /// How much more work a frame may be than one of as many particles that are evenly spread, see BackendOptions.
    double work_per_frame = 20.0;
    /// The time of a frame on the device, without its wait for a turn.
    std::chrono::milliseconds frame_time{60'000};
    /// Memory for the reconstruction of one session; the same again for its arriving frames, and for their encoding.
    std::size_t bytes_per_session = 0;
    /// A frame has the processors alone for this time while others wait. Then they have their turns beside it, and it
    /// is not stopped, as it may need its time. Not on a GPU, whose memory few frames leave room in.
    std::chrono::milliseconds turn_time{4'000};
    /// Memory for the reconstruction of one session on its GPU.
    std::size_t device_bytes_per_session = 0;
    /// Memory for all sessions' reconstructions, and for those on one GPU.
    std::size_t total_bytes = 0;
    std::size_t total_device_bytes = 0;
    /// A session without frames gives its buffers back after this time.
    std::chrono::milliseconds idle_buffers_time{0};
    /// Bytes of all sessions' frames, each until it has been reconstructed; see BytesInFlight.
    std::size_t bytes_in_flight = 0;
    /// The least pace of a frame on its way in.
    LeastPace least_pace{};
    /// Frames that the streams of one session may begin in any second.
    std::uint32_t frames_per_second = 0;
    /// Chunk messages of one frame, empty ones included.
    std::uint32_t chunks_per_frame = 65536;
    /// A stream without frames and without outstanding answers ends after it, and so does a session that nobody uses.
    std::chrono::milliseconds idle_time{0};
    /// A session whose simulator has vanished without a word ends after this time, unless it is watched or resumed.
    std::chrono::milliseconds orphan_time{0};
    /// An ephemeral session without a stream ends after this time.
    std::chrono::milliseconds ephemeral_time{5'000};
    /// Whether a surface that was made elsewhere is refused unless it is closed.
    bool check_published = false;
    /// Bytes of one message as it arrives; at least min_message_bytes.
    std::size_t message_bytes = std::size_t{4} << 20;

    /// Calls visit(name, value, facts) for each limit, and visit(name, value, facts, standard) if standard() follows
    /// from other limits where nobody gives a value. The name is that of the field of the message Limits, if the limit
    /// is announced there; a row without help has no flag, one without a gauge no metric.
    template <class Self, class Visit>
    static void rows(Self& self, const Visit& visit) {
        // The most that a flag of seconds takes.
        constexpr double long_time = 1e7;
        visit("sessions", self.sessions,
              {.help = "Sessions at a time; 0: no limit",
               .option = "max-sessions",
               .argument = "N",
               .gauge = "sessions"});
        visit("watchers_per_session", self.watchers_per_session,
              {.help = "Watchers of one session; 0: no limit",
               .option = "max-watchers",
               .argument = "N",
               .gauge = "watchers"});
        visit("formats_per_session", self.formats_per_session,
              {.help = "Formats of the meshes and numbers of particles that the watchers of one session wish for, "
                       "of which one caller has all but an eighth; 0: no limit",
               .option = "max-formats",
               .argument = "N",
               .gauge = "formats"});
        visit("connections", self.connections,
              {.help = "Connections to the gRPC port, as far as the limit of descriptors (ulimit -n) is enough; "
                       "0: as many",
               .option = "max-connections",
               .argument = "N",
               .gauge = "connections"});
        visit("connections_per_peer", self.connections_per_peer,
              {.help = "Connections from one address to one port, but for loopback, Unix sockets and "
                       "--trusted-proxies; 0: no limit",
               .option = "max-connections-per-peer",
               .argument = "N",
               .gauge = "connections_per_peer"});
        visit("sessions_per_name", self.per_name.sessions,
              {.help = "Sessions of one token's name, or without tokens of one peer address; 0: no limit. "
                       "Default: all but an eighth of --max-sessions",
               .option = "max-sessions-per-name",
               .argument = "N",
               .gauge = "sessions_per_name"},
              [&self] { return all_but_an_eighth(self.sessions); });
        visit("watchers_per_name", self.per_name.watchers,
              {.help = "Watchers of one session of one token's name, or without tokens of one peer address; 0: no "
                       "limit. Default: all but an eighth of --max-watchers",
               .option = "max-watchers-per-name",
               .argument = "N",
               .gauge = "watchers_per_name"},
              [&self] { return all_but_an_eighth(self.watchers_per_session); });
        visit("formats_per_name", self.per_name.formats, {.gauge = "formats_per_name"},
              [&self] { return all_but_an_eighth(self.formats_per_session); });
        visit("snapshots", self.snapshots, {.gauge = "snapshots"});
        visit("snapshots_per_name", self.snapshots_per_name, {.gauge = "snapshots_per_name"});
        visit("recording_readers", self.recording_readers,
              {.help = "Calls that read recordings at a time; 0: no limit",
               .option = "max-recording-readers",
               .argument = "N",
               .gauge = "recording_readers"});
        visit("reader_pause_seconds", self.reader_patience,
              {.help = "Seconds that a client that reads a recording may take for one message; 0: no limit",
               .unit = "s",
               .range = {.most = long_time},
               .option = "max-reader-pause",
               .argument = "SECONDS",
               .gauge = "reader_pause"});
        visit("particles_per_frame", self.particles_per_frame,
              {.help = "Particles of one frame; 0: no limit",
               .option = "max-particles",
               .argument = "N",
               .gauge = "particles_per_frame"});
        visit("frame_work", self.work_per_frame,
              {.help = "Times the work that as many evenly spread particles are at that cell size: a frame that "
                       "is estimated to be more is refused; 0: no limit",
               .unit = "times",
               .range = {.most = 1e9},
               .option = "max-frame-work",
               .argument = "TIMES"});
        visit("frame_seconds", self.frame_time,
              {.help = "Seconds for which one frame may have the device, after which it is stopped; 0: no limit",
               .unit = "s",
               .range = {.most = long_time},
               .option = "max-frame-seconds",
               .argument = "SECONDS",
               .gauge = "frame_time"});
        visit("bytes_in_flight", self.bytes_in_flight,
              {.help = "Frames that wait to be reconstructed, over all sessions; 0: no limit. Default: half of "
                       "the machine's memory, or of the container's",
               .unit = "bytes",
               .option = "max-bytes-in-flight",
               .argument = "BYTES",
               .gauge = "bytes_in_flight"});
        visit("frames_per_second", self.frames_per_second,
              {.help = "Frames of one session; 0: no limit",
               .unit = "frames/s",
               .option = "max-frames-per-second",
               .argument = "N",
               .gauge = "frames_per_second"});
        visit("frames_per_second_per_name", self.per_name.frames_per_second,
              {.help = "Frames over all sessions of one token's name, or without tokens of one peer address; 0, "
                       "the default: no limit",
               .unit = "frames/s",
               .option = "max-frames-per-second-per-name",
               .argument = "N",
               .gauge = "frames_per_second_per_name"},
              [] { return 0U; });
        visit("bytes_in_flight_per_name", self.per_name.bytes_in_flight,
              {.help = "Frames that wait to be reconstructed of one token's name, or without tokens of one peer "
                       "address; 0: no limit. Default: three quarters of --max-bytes-in-flight",
               .unit = "bytes",
               .option = "max-bytes-in-flight-per-name",
               .argument = "BYTES",
               .gauge = "bytes_in_flight_per_name"},
              [&self] { return self.bytes_in_flight - self.bytes_in_flight / 4; });
        visit("chunks_per_frame", self.chunks_per_frame,
              {.help = "Chunk messages of one frame; 0: no limit",
               .option = "max-chunks",
               .argument = "N",
               .gauge = "chunks_per_frame"});
        visit("chunk_bytes", chunk_bytes, {.unit = "bytes", .gauge = "chunk"});
        visit("parts_per_frame", parts_per_frame, {.gauge = "parts_per_frame"});
        visit("message_bytes", self.message_bytes,
              {.help = "Size of one message, as 4M",
               .unit = "bytes",
               .range = {.least = min_message_bytes, .most = max_message_bytes},
               .option = "max-message-bytes",
               .argument = "BYTES",
               .gauge = "message"});
        visit("upload_seconds", self.least_pace.time,
              {.help = "Seconds in which a frame must have arrived, unless it comes with --min-upload-rate; 0: no "
                       "limit",
               .unit = "s",
               .range = {.most = long_time},
               .option = "max-upload-seconds",
               .argument = "SECONDS",
               .gauge = "upload_time"});
        visit("upload_bytes_per_second", self.least_pace.bytes_per_second,
              {.help = "Bytes a second with which a frame must come after --max-upload-seconds; 0: none may take "
                       "longer",
               .unit = "bytes/s",
               .option = "min-upload-rate",
               .argument = "BYTES"});
        visit("idle_seconds", self.idle_time,
              {.help = "Seconds that a stream, or a session without streams, watchers and calls, is kept without "
                       "use; 0: no limit",
               .unit = "s",
               .range = {.most = long_time},
               .option = "max-idle",
               .argument = "SECONDS",
               .gauge = "idle_time"});
        visit("orphan_seconds", self.orphan_time,
              {.help = "Seconds that a session is kept whose simulator has vanished without a word, unless it is "
                       "watched or resumed; 0: as any other",
               .unit = "s",
               .range = {.most = long_time},
               .argument = "SECONDS",
               .gauge = "orphan_time"});
        visit("bytes_per_session", self.bytes_per_session,
              {.help = "Memory of one session's reconstruction, as 4G or 500M; 0: no limit. Default: all but an "
                       "eighth of --total-memory-limit",
               .unit = "bytes",
               .option = "memory-limit",
               .argument = "BYTES",
               .gauge = "memory_per_session"},
              [&self] { return all_but_an_eighth(self.total_bytes); });
        visit("total_bytes", self.total_bytes,
              {.help = "Memory of all sessions' reconstructions, of encoding, and of what is kept of frames; 0: "
                       "no limit. Default: half of the machine's, or of the container's",
               .unit = "bytes",
               .option = "total-memory-limit",
               .argument = "BYTES",
               .gauge = "memory"});
        visit("total_device_bytes", self.total_device_bytes,
              {.help = "Memory of all sessions' reconstructions on one GPU; 0: no limit",
               .unit = "bytes",
               .option = "total-device-memory-limit",
               .argument = "BYTES",
               .gauge = "device_memory"});
        visit("idle_buffers_seconds", self.idle_buffers_time,
              {.help = "Seconds after which a session without frames gives the memory of its reconstruction back, "
                       "and takes it again when it needs it; 0: only where others need it",
               .unit = "s",
               .range = {.most = long_time},
               .option = "idle-buffers",
               .argument = "SECONDS",
               .gauge = "idle_buffers_time"});
        visit("device_bytes_per_session", self.device_bytes_per_session,
              {.help = "Memory of one session's reconstruction on its GPU; 0: no limit",
               .unit = "bytes",
               .option = "device-memory-limit",
               .argument = "BYTES",
               .gauge = "device_memory_per_session"});
    }
};

}  // namespace meniscus::server
