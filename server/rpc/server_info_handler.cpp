#include "rpc/server_info_handler.hpp"

#include <string>

#include "conversion/codec_conversion.hpp"

namespace meniscus::server {

v1::GetServerInfoResponse get_server_info(const BackendDescription& backend, unsigned threads, const Limits& limits) {
    v1::GetServerInfoResponse response;
    response.set_version(std::string(version()));
    response.set_backend(backend.name);
    response.set_device(backend.device);
    response.set_backend_reason(backend.reason);
    response.set_threads(threads);
    conversion::add_known_codecs(*response.mutable_codecs());
    v1::Limits& wire = *response.mutable_limits();
    wire.set_sessions(limits.sessions);
    wire.set_watchers_per_session(limits.watchers_per_session);
    wire.set_particles_per_frame(limits.particles_per_frame);
    wire.set_frame_work(limits.work_per_frame);
    wire.set_frame_seconds(std::chrono::duration<double>(limits.frame_time).count());
    wire.set_bytes_per_session(limits.bytes_per_session);
    wire.set_device_bytes_per_session(limits.device_bytes_per_session);
    wire.set_chunk_bytes(chunk_bytes);
    wire.set_bytes_in_flight(limits.bytes_in_flight);
    wire.set_frames_per_second(limits.frames_per_second);
    wire.set_chunks_per_frame(limits.chunks_per_frame);
    wire.set_idle_seconds(std::chrono::duration<double>(limits.idle_time).count());
    wire.set_message_bytes(limits.message_bytes);
    wire.set_upload_seconds(limits.least_pace.time.count());
    wire.set_upload_bytes_per_second(limits.least_pace.bytes_per_second);
    wire.set_orphan_seconds(std::chrono::duration<double>(limits.orphan_time).count());
    wire.set_total_bytes(limits.total_bytes);
    wire.set_total_device_bytes(limits.total_device_bytes);
    wire.set_idle_buffers_seconds(std::chrono::duration<double>(limits.idle_buffers_time).count());
    wire.set_sessions_per_name(limits.per_name.sessions);
    wire.set_watchers_per_name(limits.per_name.watchers);
    wire.set_frames_per_second_per_name(limits.per_name.frames_per_second);
    wire.set_bytes_in_flight_per_name(limits.per_name.bytes_in_flight);
    wire.set_connections(limits.connections);
    wire.set_connections_per_peer(limits.connections_per_peer);
    wire.set_formats_per_session(limits.formats_per_session);
    wire.set_recording_readers(limits.recording_readers);
    return response;
}

}  // namespace meniscus::server
