#include "metrics/limit_gauges.hpp"

#include <fmt/format.h>

#include <chrono>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "metrics/gauge_family.hpp"

namespace meniscus::server {

namespace {

prometheus::MetricFamily build_info(const BackendDescription& backend) {
    prometheus::MetricFamily family = gauge("meniscus_build_info", "Always 1; its labels tell what runs.", 1);
    family.metric.front().label = {
        {"version", std::string(version())}, {"backend", backend.name}, {"device", backend.device}};
    return family;
}

using Values = std::initializer_list<std::pair<std::string_view, double>>;

/// A limit has the name that meniscus_refusals_total has for it, where that counts its refusals.
prometheus::MetricFamily limit_family(const char* unit, const char* help, Values values) {
    return gauges(fmt::format("meniscus_limit_{}", unit), fmt::format("What the server refuses to exceed, {}.", help),
                  "limit", values);
}

}  // namespace

std::vector<prometheus::MetricFamily> limit_gauges(const Limits& limits, const BackendDescription& backend) {
    const auto number = [](auto limit) { return static_cast<double>(limit); };
    const auto seconds = [](std::chrono::duration<double> time) { return time.count(); };
    return {build_info(backend),
            limit_family("number", "in numbers of what the limit is named after; 0: no limit",
                         {{"sessions", number(limits.sessions)},
                          {"sessions_per_name", number(limits.per_name.sessions)},
                          {"watchers", number(limits.watchers_per_session)},
                          {"watchers_per_name", number(limits.per_name.watchers)},
                          {"formats", number(limits.formats_per_session)},
                          {"formats_per_name", number(limits.per_name.formats)},
                          {"connections", number(limits.connections)},
                          {"connections_per_peer", number(limits.connections_per_peer)},
                          {"snapshots", number(limits.snapshots)},
                          {"snapshots_per_name", number(limits.snapshots_per_name)},
                          {"recording_readers", number(limits.recording_readers)},
                          {"particles_per_frame", number(limits.particles_per_frame)},
                          {"chunks_per_frame", number(limits.chunks_per_frame)}}),
            limit_family("bytes", "in bytes; 0: no limit",
                         {{"memory_per_session", number(limits.bytes_per_session)},
                          {"device_memory_per_session", number(limits.device_bytes_per_session)},
                          {"memory", number(limits.total_bytes)},
                          {"device_memory", number(limits.total_device_bytes)},
                          {"bytes_in_flight", number(limits.bytes_in_flight)},
                          {"bytes_in_flight_per_name", number(limits.per_name.bytes_in_flight)},
                          {"message", number(limits.message_bytes)},
                          {"chunk", number(chunk_bytes)}}),
            limit_family("seconds", "in seconds; 0: no limit",
                         {{"frame_time", seconds(limits.frame_time)},
                          {"upload_time", seconds(limits.least_pace.time)},
                          {"idle_time", seconds(limits.idle_time)},
                          {"orphan_time", seconds(limits.orphan_time)},
                          {"idle_buffers_time", seconds(limits.idle_buffers_time)},
                          {"reader_pause", seconds(limits.reader_patience)}}),
            limit_family("frames_per_second", "in frames begun in a second; 0: no limit",
                         {{"frames_per_second", number(limits.frames_per_second)},
                          {"frames_per_second_per_name", number(limits.per_name.frames_per_second)}}),
            gauge("meniscus_limit_upload_bytes_per_second",
                  "With which a frame must come, and be taken, that takes longer than upload_time; 0: none may.",
                  number(limits.least_pace.bytes_per_second)),
            gauge("meniscus_limit_frame_work_ratio",
                  "A frame's work over that of as many evenly spread particles; 0: no limit.", limits.work_per_frame)};
}

}  // namespace meniscus::server
