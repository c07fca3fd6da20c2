// Gauges and counters whose values are known at the moment of collection.
#pragma once

#include <prometheus/metric_family.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meniscus::server {

/// One gauge with no label.
inline prometheus::MetricFamily gauge(std::string name, std::string help, double value) {
    prometheus::ClientMetric metric;
    metric.gauge.value = value;
    return {std::move(name), std::move(help), prometheus::MetricType::Gauge, {std::move(metric)}};
}

/// One counter with no label.
inline prometheus::MetricFamily counter(std::string name, std::string help, double value) {
    prometheus::ClientMetric metric;
    metric.counter.value = value;
    return {std::move(name), std::move(help), prometheus::MetricType::Counter, {std::move(metric)}};
}

/// One gauge for each value of a label.
inline prometheus::MetricFamily gauges(std::string name, std::string help, const std::string& label,
                                       const std::vector<std::pair<std::string_view, double>>& values) {
    prometheus::MetricFamily family{std::move(name), std::move(help), prometheus::MetricType::Gauge, {}};
    for (const auto& [value_of_label, value] : values) {
        prometheus::ClientMetric& metric = family.metric.emplace_back();
        metric.label.push_back({label, std::string(value_of_label)});
        metric.gauge.value = value;
    }
    return family;
}

}  // namespace meniscus::server
