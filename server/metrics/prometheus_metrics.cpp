#include "metrics/prometheus_metrics.hpp"

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <array>
#include <string>

#include "meniscus/names.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus::server {

namespace {

/// Three per decade, from the stages of a small frame to a frame of many millions of particles.
const prometheus::Histogram::BucketBoundaries seconds_buckets{
    0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 25.0, 50.0};

double number(std::uint64_t count) {
    return static_cast<double>(count);
}

prometheus::Labels labels_of(const Metrics::Method& method) {
    return {{"grpc_type", std::string(method.type)},
            {"grpc_service", std::string(method.service)},
            {"grpc_method", std::string(method.name)}};
}

/// An instrument for each enumerator of E, labeled with its name.
template <class E, class Instrument>
class PerChoice {
public:
    /// make: from a name to the instrument.
    explicit PerChoice(const auto& make) {
        for (std::size_t i = 0; i < all_.size(); ++i) all_[i] = make(names<E>[i]);
    }
    Instrument& operator[](E choice) const { return *all_[static_cast<std::size_t>(choice)]; }

private:
    std::array<Instrument*, choices<E>.size()> all_{};
};

}  // namespace

struct PrometheusMetrics::Instruments {
    prometheus::Counter& counter(const char* name, const char* help, const prometheus::Labels& labels = {}) {
        return prometheus::BuildCounter().Name(name).Help(help).Register(registry).Add(labels);
    }
    prometheus::Histogram& seconds(const char* name, const char* help, const prometheus::Labels& labels = {}) {
        return prometheus::BuildHistogram().Name(name).Help(help).Register(registry).Add(labels, seconds_buckets);
    }
    prometheus::Histogram& stage(std::string_view name) {
        return seconds("meniscus_frame_stage_seconds", "Time of one step of a frame.", {{"stage", std::string(name)}});
    }
    prometheus::Counter& dropped(std::string_view reason) {
        return counter("meniscus_frames_dropped_total", "Frames dropped by the policy of their stream.",
                       {{"reason", std::string(reason)}});
    }
    prometheus::Counter& sent(std::string_view to) {
        return counter("meniscus_sent_bytes_total", "Bytes of the messages of Stream and Watch.",
                       {{"to", std::string(to)}});
    }

    /// What the server knows itself of any surface, wherever it was made: a publisher may say anything of the rest, and
    /// a counter never comes down.
    void count(const FrameStatistics& statistics) const {
        frames.Increment();
        triangles.Increment(number(statistics.triangles));
        mesh_bytes.Increment(number(statistics.encoded_bytes));
        latency.Observe(statistics.latency_seconds);
    }

    prometheus::Registry registry;

    prometheus::Counter& frames =
        counter("meniscus_frames_total", "Frames answered: reconstructed, or published as finished bricks.");
    prometheus::Counter& surfaces =
        counter("meniscus_surfaces_published_total", "Of those, frames of finished bricks.");
    prometheus::Counter& particles = counter("meniscus_particles_total", "Particles of those that were reconstructed.");
    prometheus::Counter& spray =
        counter("meniscus_spray_particles_total", "Of those particles, the ones without company.");
    prometheus::Counter& particle_volume =
        counter("meniscus_particle_volume_total", "Volume of those particles, (2 r)^3 each, world units cubed.");
    prometheus::Counter& triangles = counter("meniscus_triangles_total", "Triangles of all meshes.");
    prometheus::Counter& mesh_volume =
        counter("meniscus_mesh_volume_total", "Volume that the meshes of those particles enclose, world units cubed.");
    prometheus::Counter& upload_bytes = counter("meniscus_upload_bytes_total", "Bytes of frames received whole.");
    prometheus::Counter& mesh_bytes =
        counter("meniscus_mesh_bytes_total", "Bytes of encoded bricks, each encoding counted once.");
    PerChoice<DropReason, prometheus::Counter> drops{[this](std::string_view name) { return &dropped(name); }};
    PerChoice<Metrics::Receiver, prometheus::Counter> sent_bytes{[this](std::string_view name) { return &sent(name); }};
    prometheus::Counter& skipped = counter("meniscus_watcher_frames_skipped_total",
                                           "Frames that a watcher had not taken before a newer one came.");

    PerChoice<Stage, prometheus::Histogram> stages{[this](std::string_view name) { return &stage(name); }};
    prometheus::Histogram& download = stage("download");
    prometheus::Histogram& encode = stage("encode");
    prometheus::Histogram& reconstruction =
        seconds("meniscus_frame_reconstruction_seconds", "All steps of a frame but its download and encoding.");
    prometheus::Histogram& latency =
        seconds("meniscus_frame_latency_seconds", "From a frame's last byte to the end of its encoding.");
    prometheus::Histogram& lag = seconds("meniscus_watcher_lag_seconds",
                                         "From a frame's last byte until a watcher has taken the end of its mesh.");

    // The names, labels and codes of gRPC's libraries for other languages, which published dashboards ask for.
    prometheus::Family<prometheus::Counter>& calls_started = prometheus::BuildCounter()
                                                                 .Name("grpc_server_started_total")
                                                                 .Help("Calls that have come in.")
                                                                 .Register(registry);
    prometheus::Family<prometheus::Counter>& calls_handled = prometheus::BuildCounter()
                                                                 .Name("grpc_server_handled_total")
                                                                 .Help("Calls that have ended, by status code.")
                                                                 .Register(registry);
    prometheus::Family<prometheus::Histogram>& calls_handling =
        prometheus::BuildHistogram()
            .Name("grpc_server_handling_seconds")
            .Help("From a call's beginning to its end; that of a stream is its simulator's or watcher's.")
            .Register(registry);
    prometheus::Family<prometheus::Counter>& refusals =
        prometheus::BuildCounter()
            .Name("meniscus_refusals_total")
            .Help("Calls refused, by reason (a limit's name, or what was wrong) and by the name of the caller's token.")
            .Register(registry);
};

PrometheusMetrics::PrometheusMetrics() : instruments_(std::make_unique<Instruments>()) {}
PrometheusMetrics::~PrometheusMetrics() = default;

void PrometheusMetrics::frame_received(std::uint64_t bytes) {
    instruments_->upload_bytes.Increment(number(bytes));
}

void PrometheusMetrics::frame_dropped(DropReason reason) {
    instruments_->drops[reason].Increment();
}

void PrometheusMetrics::frame_finished(const FrameStatistics& statistics) {
    instruments_->count(statistics);
    instruments_->particles.Increment(number(statistics.particles));
    instruments_->spray.Increment(number(statistics.spray_particles));
    instruments_->particle_volume.Increment(statistics.particle_volume);
    instruments_->mesh_volume.Increment(statistics.volume);
    for (const Stage stage : choices<Stage>)
        instruments_->stages[stage].Observe(statistics.stage_seconds[static_cast<std::size_t>(stage)]);
    instruments_->reconstruction.Observe(statistics.total_seconds);
    if (statistics.download_seconds != 0.0) instruments_->download.Observe(statistics.download_seconds);
    if (statistics.encoded_bytes != 0) instruments_->encode.Observe(statistics.encode_seconds);
}

void PrometheusMetrics::surface_finished(const FrameStatistics& statistics) {
    instruments_->surfaces.Increment();
    instruments_->count(statistics);
}

void PrometheusMetrics::message_sent(Receiver to, std::uint64_t bytes) {
    instruments_->sent_bytes[to].Increment(number(bytes));
}

void PrometheusMetrics::frame_skipped() {
    instruments_->skipped.Increment();
}

void PrometheusMetrics::watcher_lag(double seconds) {
    instruments_->lag.Observe(seconds);
}

void PrometheusMetrics::call_started(const Method& method) {
    instruments_->calls_started.Add(labels_of(method)).Increment();
}

void PrometheusMetrics::call_ended(const Method& method, std::string_view code, double seconds) {
    prometheus::Labels labels = labels_of(method);
    instruments_->calls_handling.Add(labels, seconds_buckets).Observe(seconds);
    labels.emplace("grpc_code", code);
    instruments_->calls_handled.Add(labels).Increment();
}

void PrometheusMetrics::refused(std::string_view reason, std::string_view name) {
    instruments_->refusals.Add({{"reason", std::string(reason)}, {"name", std::string(name)}}).Increment();
}

std::vector<prometheus::MetricFamily> PrometheusMetrics::collect() const {
    return instruments_->registry.Collect();
}

}  // namespace meniscus::server
