#include "metrics/publication_metrics.hpp"

#include "metrics/gauge_family.hpp"

namespace meniscus::server {

std::vector<prometheus::MetricFamily> publication_metrics(const PublishingCounters& counters,
                                                          std::size_t publications) {
    const auto number = [](std::uint64_t count) { return static_cast<double>(count); };
    return {gauge("meniscus_publications", "Publications, those of sessions that have ended included.",
                  number(publications)),
            gauge("meniscus_publication_bytes",
                  "Bytes of their files in memory, those included that have left and are being sent.",
                  number(counters.held)),
            counter("meniscus_published_frames_total", "Frames in segments of publications.", number(counters.frames)),
            counter("meniscus_published_bytes_total", "Bytes of segments of publications.", number(counters.bytes)),
            counter("meniscus_publication_left_out_total",
                    "Frames that had no room, or left their publication before their time for want of it.",
                    number(counters.left_out)),
            counter("meniscus_publication_sent_bytes_total", "Bytes of files of publications that were asked for.",
                    number(counters.sent))};
}

}  // namespace meniscus::server
