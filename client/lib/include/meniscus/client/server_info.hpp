// A server's description of itself.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "meniscus/described.hpp"

namespace meniscus::client {

struct ServerInfo {
    std::string version;
    std::string backend;  ///< "cpu" or "cuda"
    std::string device;
    std::string backend_reason;
    unsigned threads = 0;
    std::uint32_t max_sessions = 0;  ///< 0: no limit, here and below
    std::uint32_t max_watchers_per_session = 0;
    std::uint64_t max_particles_per_frame = 0;
    double max_frame_work = 0.0;     ///< times that of as many evenly spread particles
    double max_frame_seconds = 0.0;  ///< on the device
    std::uint64_t max_bytes_per_session = 0;
    std::uint64_t max_device_bytes_per_session = 0;
    std::uint64_t max_bytes_in_flight = 0;    ///< of all sessions' frames
    std::uint32_t max_frames_per_second = 0;  ///< of one session
    std::uint32_t max_chunks_per_frame = 0;
    double max_idle_seconds = 0.0;
    double max_upload_seconds = 0.0;  ///< of a frame that comes more slowly than with the rate that follows
    std::uint64_t min_upload_bytes_per_second = 0;
    double max_orphan_seconds = 0.0;           ///< of a session whose simulator has vanished
    std::uint64_t max_total_bytes = 0;         ///< of all sessions' reconstructions
    std::uint64_t max_total_device_bytes = 0;  ///< of those on one GPU
    double max_idle_buffers_seconds = 0.0;
    std::uint32_t max_sessions_per_name = 0;  ///< of one token's name, or without tokens of one peer address
    std::uint32_t max_watchers_per_name = 0;  ///< of one session
    std::uint32_t max_frames_per_second_per_name = 0;
    std::uint64_t max_bytes_in_flight_per_name = 0;
    std::uint32_t max_connections = 0;           ///< to the gRPC port
    std::uint32_t max_connections_per_peer = 0;  ///< from one address that is no trusted proxy's
    std::uint32_t max_recording_readers = 0;
    std::uint32_t max_formats_per_session = 0;  ///< of meshes, and numbers of particles, that its watchers ask for
    std::uint64_t max_message_bytes = 0;
    std::vector<std::uint32_t> codecs;  ///< numbers of those that the server encodes with; codec.hpp names them
    bool publishes = false;             ///< whether sessions may be published, see SessionOptions
    bool checks_published = false;      ///< whether the surfaces of Publisher are refused unless they are closed

    /// The limits, in the order in which people read them, with their labels. On the wire they have no max_ and min_.
    template <class Visit>
    static void rows(const Visit& visit) {
        using S = ServerInfo;
        constexpr std::string_view of_the_former = "of the former";
        constexpr std::string_view of_one_name = "of one name, or of one address where the server asks for no tokens";
        visit("max_sessions", &S::max_sessions, {.help = "sessions"});
        visit("max_watchers_per_session", &S::max_watchers_per_session, {.help = "watchers per session"});
        visit("max_formats_per_session", &S::max_formats_per_session,
              {.help = "formats of them", .group = of_the_former});
        visit("max_particles_per_frame", &S::max_particles_per_frame, {.help = "particles per frame"});
        visit("max_frame_work", &S::max_frame_work, {.help = "work per frame"});
        visit("max_frame_seconds", &S::max_frame_seconds, {.help = "seconds per frame"});
        visit("max_bytes_per_session", &S::max_bytes_per_session, {.help = "bytes per session"});
        visit("max_device_bytes_per_session", &S::max_device_bytes_per_session, {.help = "GPU bytes per session"});
        visit("max_bytes_in_flight", &S::max_bytes_in_flight, {.help = "bytes in flight"});
        visit("max_frames_per_second", &S::max_frames_per_second, {.help = "frames per second"});
        visit("max_chunks_per_frame", &S::max_chunks_per_frame, {.help = "chunks per frame"});
        visit("max_message_bytes", &S::max_message_bytes, {.help = "bytes per message"});
        visit("max_idle_seconds", &S::max_idle_seconds, {.help = "idle seconds"});
        visit("max_upload_seconds", &S::max_upload_seconds, {.help = "upload seconds"});
        visit("min_upload_bytes_per_second", &S::min_upload_bytes_per_second, {.help = "upload bytes/second"});
        visit("max_orphan_seconds", &S::max_orphan_seconds, {.help = "orphan seconds"});
        visit("max_total_bytes", &S::max_total_bytes, {.help = "bytes of all sessions"});
        visit("max_total_device_bytes", &S::max_total_device_bytes, {.help = "on one GPU", .group = of_the_former});
        visit("max_idle_buffers_seconds", &S::max_idle_buffers_seconds, {.help = "idle buffers seconds"});
        visit("max_connections", &S::max_connections, {.help = "connections"});
        visit("max_connections_per_peer", &S::max_connections_per_peer,
              {.help = "from one address", .group = of_the_former});
        visit("max_recording_readers", &S::max_recording_readers, {.help = "readers of recordings"});
        visit("max_sessions_per_name", &S::max_sessions_per_name, {.help = "sessions", .group = of_one_name});
        visit("max_watchers_per_name", &S::max_watchers_per_name,
              {.help = "watchers per session", .group = of_one_name});
        visit("max_frames_per_second_per_name", &S::max_frames_per_second_per_name,
              {.help = "frames per second", .group = of_one_name});
        visit("max_bytes_in_flight_per_name", &S::max_bytes_in_flight_per_name,
              {.help = "bytes in flight", .group = of_one_name});
    }
};

}  // namespace meniscus::client
