#include "metrics/recording_metrics.hpp"

#include "metrics/gauge_family.hpp"

namespace meniscus::server {

std::vector<prometheus::MetricFamily> recording_metrics(const RecordingCounters& counters, std::uint32_t readers) {
    const auto number = [](std::uint64_t count) { return static_cast<double>(count); };
    return {counter("meniscus_recorded_frames_total", "Frames whose particles were recorded.", number(counters.frames)),
            counter("meniscus_recorded_bytes_total", "Bytes written to recordings.", number(counters.bytes)),
            counter("meniscus_recording_left_out_total",
                    "Particles or meshes of frames that were not recorded: the disk was too slow.",
                    number(counters.frames_left_out)),
            counter("meniscus_recordings_stopped_total", "Recordings that a failure or the limit has ended.",
                    number(counters.stopped)),
            gauge("meniscus_recording_readers", "Calls that read recordings.", readers)};
}

}  // namespace meniscus::server
