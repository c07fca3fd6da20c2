// What the server refuses to exceed. 0 means no limit.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "sessions/limits/name_shares.hpp"
#include "sessions/limits/upload_pace.hpp"

namespace meniscus::server {

/// The most bytes of one chunk of particle data, and of one part of a brick.
inline constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

struct Limits {
    std::uint32_t sessions = 16;
    /// Of one token's name, or without tokens of one peer address.
    NameShares per_name{};
    std::uint32_t watchers_per_session = 64;
    /// Of all watchers of a session: each is encoded once for each frame; see WatchForm.
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
    /// Such a call ends if its client takes no message for so long.
    std::chrono::milliseconds reader_patience{60'000};
    std::uint64_t particles_per_frame = 0;
    /// How much more work a frame may be than one of as many particles that are evenly spread, see BackendOptions.
    double work_per_frame = 20.0;
    /// Of a frame on the device; not that for which it waits for its turn.
    std::chrono::milliseconds frame_time{60'000};
    /// For the reconstruction of one session, as much again for its frames on their way in, and for their encoding.
    std::size_t bytes_per_session = 0;
    /// For the reconstruction of one session on its GPU.
    std::size_t device_bytes_per_session = 0;
    /// For all sessions' reconstructions, and for those on one GPU.
    std::size_t total_bytes = 0;
    std::size_t total_device_bytes = 0;
    /// A session without frames gives its buffers back after it.
    std::chrono::milliseconds idle_buffers_time{0};
    /// Bytes of all sessions' frames, each until it has been reconstructed; see BytesInFlight.
    std::size_t bytes_in_flight = 0;
    /// Of a frame on its way in.
    LeastPace least_pace{};
    /// Frames that the streams of one session may begin in any second.
    std::uint32_t frames_per_second = 0;
    /// Chunk messages of one frame, empty ones included.
    std::uint32_t chunks_per_frame = 65536;
    /// A stream without frames and without outstanding answers ends after it, and so does a session that nobody uses.
    std::chrono::milliseconds idle_time{0};
    /// A session whose simulator has vanished without a word ends after it, unless it is watched or resumed.
    std::chrono::milliseconds orphan_time{0};
    /// An ephemeral session without a stream ends after it.
    std::chrono::milliseconds ephemeral_time{5'000};
    /// Of one message as it arrives; at least that of a full chunk.
    std::size_t message_bytes = std::size_t{4} << 20;
};

}  // namespace meniscus::server
