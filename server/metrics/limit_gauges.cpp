#include "metrics/limit_gauges.hpp"

#include <fmt/format.h>

#include <chrono>
#include <string_view>
#include <utility>
#include <vector>

#include "meniscus/seconds.hpp"
#include "metrics/gauge_family.hpp"

namespace meniscus::server {

namespace {

prometheus::MetricFamily build_info(const BackendDescription& backend) {
    prometheus::MetricFamily family = gauge("meniscus_build_info", "Always 1; its labels tell what runs.", 1);
    family.metric.front().label = {
        {"version", std::string(version())}, {"backend", backend.name}, {"device", backend.device}};
    return family;
}

double number_of(std::chrono::milliseconds limit) {
    return seconds_of(limit);
}

template <class Number>
double number_of(Number limit) {
    return static_cast<double>(limit);
}

/// The limits of one unit. A limit has the name that meniscus_refusals_total has for it, where that counts its
/// refusals.
prometheus::MetricFamily limit_family(const Limits& limits, std::string_view unit, const char* name, const char* help) {
    std::vector<std::pair<std::string_view, double>> values;
    Limits::rows(limits, [&](std::string_view, const auto& limit, const Facts& facts, const auto&...) {
        if (facts.unit == unit && !facts.gauge.empty()) values.emplace_back(facts.gauge, number_of(limit));
    });
    return gauges(fmt::format("meniscus_limit_{}", name), fmt::format("What the server refuses to exceed, {}.", help),
                  "limit", values);
}

}  // namespace

std::vector<prometheus::MetricFamily> limit_gauges(const Limits& limits, const BackendDescription& backend) {
    return {build_info(backend),
            limit_family(limits, "", "number", "in numbers of what the limit is named after; 0: no limit"),
            limit_family(limits, "bytes", "bytes", "in bytes; 0: no limit"),
            limit_family(limits, "s", "seconds", "in seconds; 0: no limit"),
            limit_family(limits, "frames/s", "frames_per_second", "in frames begun in a second; 0: no limit"),
            gauge("meniscus_limit_upload_bytes_per_second",
                  "With which a frame must come, and be taken, that takes longer than upload_time; 0: none may.",
                  number_of(limits.least_pace.bytes_per_second)),
            gauge("meniscus_limit_frame_work_ratio",
                  "A frame's work over that of as many evenly spread particles; 0: no limit.", limits.work_per_frame)};
}

}  // namespace meniscus::server
