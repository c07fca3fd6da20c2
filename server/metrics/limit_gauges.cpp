#include "metrics/limit_gauges.hpp"

#include <string>

#include "metrics/gauge_family.hpp"

namespace meniscus::server {

namespace {

prometheus::MetricFamily build_info(const BackendDescription& backend) {
    prometheus::MetricFamily family = gauge("meniscus_build_info", "Always 1; its labels tell what runs.", 1);
    family.metric.front().label = {
        {"version", std::string(version())}, {"backend", backend.name}, {"device", backend.device}};
    return family;
}

}  // namespace

std::vector<prometheus::MetricFamily> limit_gauges(const Limits& limits, const BackendDescription& backend) {
    const auto number = [](auto limit) { return static_cast<double>(limit); };
    return {build_info(backend),
            gauges("meniscus_limit", "What the server refuses to exceed, in the unit of the name; 0: no limit.", "name",
                   {{"sessions", number(limits.sessions)},
                    {"watchers_per_session", number(limits.watchers_per_session)},
                    {"formats_per_session", number(limits.formats_per_session)},
                    {"connections", number(limits.connections)},
                    {"connections_per_peer", number(limits.connections_per_peer)},
                    {"recording_readers", number(limits.recording_readers)},
                    {"reader_pause_seconds", std::chrono::duration<double>(limits.reader_patience).count()},
                    {"particles_per_frame", number(limits.particles_per_frame)},
                    {"frame_work", limits.work_per_frame},
                    {"frame_seconds", std::chrono::duration<double>(limits.frame_time).count()},
                    {"bytes_per_session", number(limits.bytes_per_session)},
                    {"device_bytes_per_session", number(limits.device_bytes_per_session)},
                    {"chunk_bytes", number(chunk_bytes)},
                    {"bytes_in_flight", number(limits.bytes_in_flight)},
                    {"frames_per_second", number(limits.frames_per_second)},
                    {"chunks_per_frame", number(limits.chunks_per_frame)},
                    {"idle_seconds", std::chrono::duration<double>(limits.idle_time).count()},
                    {"message_bytes", number(limits.message_bytes)},
                    {"upload_seconds", limits.least_pace.time.count()},
                    {"upload_bytes_per_second", number(limits.least_pace.bytes_per_second)},
                    {"orphan_seconds", std::chrono::duration<double>(limits.orphan_time).count()},
                    {"total_bytes", number(limits.total_bytes)},
                    {"total_device_bytes", number(limits.total_device_bytes)},
                    {"idle_buffers_seconds", std::chrono::duration<double>(limits.idle_buffers_time).count()},
                    {"sessions_per_name", number(limits.per_name.sessions)},
                    {"watchers_per_name", number(limits.per_name.watchers)},
                    {"frames_per_second_per_name", number(limits.per_name.frames_per_second)},
                    {"bytes_in_flight_per_name", number(limits.per_name.bytes_in_flight)}})};
}

}  // namespace meniscus::server
