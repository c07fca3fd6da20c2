// The service's counters and histograms, for Prometheus.
#pragma once

#include <prometheus/metric_family.h>

#include <memory>
#include <vector>

#include "sessions/sending/metrics.hpp"

namespace meniscus::server {

class PrometheusMetrics final : public Metrics {
public:
    PrometheusMetrics();
    ~PrometheusMetrics() override;

    void frame_received(std::uint64_t bytes) override;
    void frame_dropped(DropReason reason) override;
    void frame_finished(const FrameStatistics& statistics) override;
    void surface_finished(const FrameStatistics& statistics) override;
    void message_sent(Receiver to, std::uint64_t bytes) override;
    void frame_skipped() override;
    void watcher_lag(double seconds) override;
    void call_started(const Method& method) override;
    void call_ended(const Method& method, std::string_view code, double seconds) override;
    void refused(std::string_view reason, std::string_view name) override;

    /// The values of this moment.
    std::vector<prometheus::MetricFamily> collect() const;

private:
    struct Instruments;
    const std::unique_ptr<Instruments> instruments_;
};

}  // namespace meniscus::server
