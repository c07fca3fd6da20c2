// What a server says of itself.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

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
};

}  // namespace meniscus::client
