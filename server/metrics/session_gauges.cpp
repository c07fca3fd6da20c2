#include "metrics/session_gauges.hpp"

#include "metrics/gauge_family.hpp"

namespace meniscus::server {

std::vector<prometheus::MetricFamily> session_gauges(SessionRegistry& registry) {
    double sessions = 0;
    double uploads = 0;
    double watchers = 0;
    double host_bytes = 0;
    double device_bytes = 0;
    for (const auto& session : registry.list()) {
        const SessionState state = session->state();
        sessions += 1;
        uploads += state.uploading ? 1 : 0;
        watchers += state.watchers;
        if (!state.last_frame) continue;
        host_bytes += static_cast<double>(state.last_frame->peak_bytes);
        device_bytes += static_cast<double>(state.last_frame->device_bytes);
    }
    return {
        gauge("meniscus_sessions", "Sessions open.", sessions),
        gauge("meniscus_uploads", "Streams that upload to a session.", uploads),
        counter("meniscus_device_busy_seconds_total", "Time that the devices have spent on frames, over all of them.",
                registry.busy_time().count()),
        gauge("meniscus_watchers", "Watchers of all sessions.", watchers),
        gauges("meniscus_host_bytes",
               "Host memory of all sessions, by what it is for; of reconstructions the most that each held.", "pool",
               {{"reconstruction", host_bytes},
                {"reconstruction_now", static_cast<double>(registry.reconstruction_bytes())},
                {"frames_in_flight", static_cast<double>(registry.bytes_in_flight())}}),
        gauges("meniscus_device_bytes", "GPU memory of all sessions, by what it is for.", "pool",
               {{"reconstruction", device_bytes}})};
}

}  // namespace meniscus::server
