#include "metrics/connection_metrics.hpp"

#include "metrics/gauge_family.hpp"

namespace meniscus::server {

std::vector<prometheus::MetricFamily> connection_metrics(const GrpcPort::Counts& counts) {
    prometheus::MetricFamily refused{"meniscus_connections_refused_total",
                                     "Connections to the gRPC port that were one too many, in all or of their address.",
                                     prometheus::MetricType::Counter,
                                     {}};
    const auto add = [&refused](const char* limit, std::uint64_t value) {
        prometheus::ClientMetric& metric = refused.metric.emplace_back();
        metric.label.push_back({"limit", limit});
        metric.counter.value = static_cast<double>(value);
    };
    add("connections", counts.refused_of_all);
    add("connections_per_peer", counts.refused_of_peers);
    return {gauge("meniscus_connections", "Connections to the gRPC port.", static_cast<double>(counts.connections)),
            std::move(refused)};
}

}  // namespace meniscus::server
