#include "metrics/recording_metrics.hpp"

#include <string>
#include <utility>

#include "metrics/gauge_family.hpp"

namespace meniscus::server {

namespace {

prometheus::MetricFamily counter(std::string name, std::string help, std::uint64_t value) {
    prometheus::ClientMetric metric;
    metric.counter.value = static_cast<double>(value);
    return {std::move(name), std::move(help), prometheus::MetricType::Counter, {std::move(metric)}};
}

}  // namespace

std::vector<prometheus::MetricFamily> recording_metrics(const RecordingCounters& counters, std::uint32_t readers) {
    return {counter("meniscus_recorded_frames_total", "Frames whose particles were recorded.", counters.frames),
            counter("meniscus_recorded_bytes_total", "Bytes written to recordings.", counters.bytes),
            counter("meniscus_recording_left_out_total", "Particles or meshes of frames that were not recorded: the disk was too slow.",
                    counters.frames_left_out),
            counter("meniscus_recordings_stopped_total", "Recordings that a failure or the limit has ended.", counters.stopped),
            gauge("meniscus_recording_readers", "Calls that read recordings.", readers)};
}

}  // namespace meniscus::server
