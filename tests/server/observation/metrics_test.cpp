// /metrics tells what was done.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "meniscus/error.hpp"
#include "meniscus/statistics.hpp"
#include "observation/metrics.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

ServerOptions with_http() {
    ServerOptions options = test_options();
    options.http = "127.0.0.1:0";
    return options;
}

TEST(Metrics, CountWhatWasDone) {
    RunningServer running(with_http());
    const std::string id = running.session();
    const std::string& http = running.server.http_address();
    auto watcher = running.client.watch(id);
    auto stream = running.client.stream(id);
    double particles = 0;
    double triangles = 0;
    double encoded_bytes = 0;
    double particle_volume = 0;
    double mesh_volume = 0;
    double spray = 0;
    for (std::uint64_t i = 0; i < 3; ++i) {
        const Particles frame = wave(6, 0.1 * static_cast<double>(i));
        stream.push(frame.view(), i, 0.0);
        const auto received = stream.next();
        ASSERT_TRUE(received);
        particles += static_cast<double>(frame.view().count());
        triangles += static_cast<double>(received->statistics.triangles);
        encoded_bytes += static_cast<double>(received->statistics.encoded_bytes);
        particle_volume += received->statistics.particle_volume;
        mesh_volume += received->statistics.volume;
        spray += static_cast<double>(received->statistics.spray_particles);
        ASSERT_TRUE(watcher.next());
    }
    const Samples samples = scrape_until(http, "meniscus_frames_total", 3);
    EXPECT_EQ(samples.at("meniscus_particles_total"), particles);
    EXPECT_EQ(samples.at("meniscus_triangles_total"), triangles);
    EXPECT_EQ(samples.at("meniscus_upload_bytes_total"), particles * 12);
    EXPECT_EQ(samples.at("meniscus_mesh_bytes_total"), encoded_bytes);
    EXPECT_GT(mesh_volume, 0.5 * particle_volume);
    EXPECT_NEAR(particle_volume, particles * 8 * radius * radius * radius, 1e-9 * particle_volume);
    EXPECT_NEAR(samples.at("meniscus_particle_volume_total"), particle_volume, 1e-5 * particle_volume);
    EXPECT_NEAR(samples.at("meniscus_mesh_volume_total"), mesh_volume, 1e-5 * mesh_volume);
    EXPECT_EQ(samples.at("meniscus_spray_particles_total"), spray);
    // The bricks, and around them what begins and ends each mesh.
    EXPECT_GT(samples.at("meniscus_sent_bytes_total{to=\"simulator\"}"), encoded_bytes);
    EXPECT_GT(samples.at("meniscus_sent_bytes_total{to=\"watcher\"}"), encoded_bytes / 3);
    EXPECT_EQ(samples.at("meniscus_frame_latency_seconds_count"), 3);
    EXPECT_GT(samples.at("meniscus_frame_latency_seconds_sum"),
              samples.at("meniscus_frame_reconstruction_seconds_sum"));
    double stage_seconds = 0;
    for (const std::string_view stage : names<Stage>) {
        const std::string label = "{stage=\"" + std::string(stage) + "\"}";
        EXPECT_EQ(samples.at("meniscus_frame_stage_seconds_count" + label), 3) << stage;
        stage_seconds += samples.at("meniscus_frame_stage_seconds_sum" + label);
    }
    EXPECT_LE(stage_seconds, samples.at("meniscus_frame_reconstruction_seconds_sum"));
    EXPECT_EQ(samples.at("meniscus_frame_stage_seconds_count{stage=\"encode\"}"), 3);
    EXPECT_GE(samples.at("meniscus_device_busy_seconds_total"),
              samples.at("meniscus_frame_reconstruction_seconds_sum"));
    EXPECT_EQ(samples.at("meniscus_sessions"), 1);
    EXPECT_EQ(samples.at("meniscus_uploads"), 1);
    EXPECT_EQ(samples.at("meniscus_watchers"), 1);
    EXPECT_GT(samples.at("meniscus_host_bytes{pool=\"reconstruction\"}"), 0);
}

TEST(Metrics, FollowSessionsThatEnd) {
    RunningServer running(with_http());
    const std::string id = running.session();
    EXPECT_EQ(scrape(running.server.http_address()).at("meniscus_sessions"), 1);
    running.client.delete_session(id);
    EXPECT_EQ(scrape(running.server.http_address()).at("meniscus_sessions"), 0);
}

TEST(Metrics, CountCallsByStatus) {
    RunningServer running(with_http());
    const std::string id = running.session();
    EXPECT_THROW(running.client.session(client::new_session_id()), client::ServerError);
    EXPECT_THROW(running.client.session("no UUID"), InvalidInput);
    RawStream nonsense(running.server.address(), id);
    nonsense.send_end();
    EXPECT_FALSE(nonsense.finish().ok());
    const Samples samples = scrape(running.server.http_address());
    EXPECT_EQ(samples.at("meniscus_calls_total{code=\"OK\"}"), 1);
    EXPECT_EQ(samples.at("meniscus_calls_total{code=\"NOT_FOUND\"}"), 1);
    EXPECT_EQ(samples.at("meniscus_calls_total{code=\"INVALID_ARGUMENT\"}"), 2);
}

TEST(Metrics, StateTheLimits) {
    ServerOptions options = with_http();
    options.limits.sessions = 5;
    options.limits.watchers_per_session = 6;
    options.limits.recording_readers = 9;
    options.limits.particles_per_frame = 7;
    options.limits.bytes_per_session = 8'000'000'000;
    const RunningServer running(options);
    const Samples samples = scrape(running.server.http_address());
    EXPECT_EQ(samples.at("meniscus_limit{name=\"sessions\"}"), 5);
    EXPECT_EQ(samples.at("meniscus_limit{name=\"watchers_per_session\"}"), 6);
    EXPECT_EQ(samples.at("meniscus_limit{name=\"recording_readers\"}"), 9);
    EXPECT_EQ(samples.at("meniscus_limit{name=\"particles_per_frame\"}"), 7);
    EXPECT_EQ(samples.at("meniscus_limit{name=\"bytes_per_session\"}"), 8'000'000'000);
}

TEST(Metrics, DoNotGrowWithSessions) {
    RunningServer running(with_http());
    const auto count = [&] { return scrape(running.server.http_address()).size(); };
    running.client.delete_session(running.session());
    const std::size_t before = count();
    for (int i = 0; i < 8; ++i) running.session();
    EXPECT_EQ(count(), before);
}

/// By the tool that comes with Prometheus.
TEST(Metrics, PassPrometheusOwnCheck) {
    if (std::system("command -v promtool >/dev/null") != 0)
        GTEST_SKIP() << "promtool is not installed (Debian: prometheus)";
    RunningServer running(with_http());
    auto stream = running.client.stream(running.session());
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    ASSERT_TRUE(stream.next());
    const auto path = std::filesystem::temp_directory_path() / ("meniscus-metrics-" + std::to_string(::getpid()));
    std::ofstream(path) << http_get(running.server.http_address(), "/metrics").body;
    EXPECT_EQ(std::system(("promtool check metrics < " + path.string()).c_str()), 0);
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace meniscus::server::test
