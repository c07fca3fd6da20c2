// /metrics counts the work that was done.
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <utility>

#include "meniscus/error.hpp"
#include "meniscus/names.hpp"
#include "meniscus/statistics.hpp"
#include "observation/metrics.hpp"
#include "rpc/services/known_methods.hpp"
#include "running_server.hpp"
#include "sessions/limits/limit_reached.hpp"

namespace meniscus::server::test {
namespace {

ServerOptions with_http() {
    ServerOptions options = test_options();
    options.http = "127.0.0.1:0";
    return options;
}

/// The series of one of the server's own calls. code: such as "NotFound".
std::string handled(const std::string& type, const std::string& service, const std::string& method,
                    const std::string& code) {
    return "grpc_server_handled_total{grpc_code=\"" + code + "\",grpc_method=\"" + method +
           "\",grpc_service=\"meniscus.v1." + service + "\",grpc_type=\"" + type + "\"}";
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
    EXPECT_EQ(samples.at(handled("unary", "SessionService", "CreateSession", "OK")), 1);
    EXPECT_EQ(samples.at(handled("unary", "SessionService", "GetSession", "NotFound")), 1);
    EXPECT_EQ(samples.at(handled("unary", "SessionService", "GetSession", "InvalidArgument")), 1);
    EXPECT_EQ(samples.at(handled("bidi_stream", "SurfaceService", "Stream", "InvalidArgument")), 1);
    EXPECT_EQ(sum_of(samples, "grpc_server_handled_total{", "grpc_code=\"NotFound\""), 1);
}

TEST(Metrics, CountCallsThatRunAmongThoseStartedAlone) {
    RunningServer running(with_http());
    const std::string id = running.session();
    const std::string labels =
        "{grpc_method=\"Watch\",grpc_service=\"meniscus.v1.SurfaceService\",grpc_type=\"server_stream\"}";
    const std::string ended = handled("server_stream", "SurfaceService", "Watch", "OK");
    {
        auto watcher = running.client.watch(id);
        const Samples samples = scrape_until(running.server.http_address(), "grpc_server_started_total" + labels, 1);
        EXPECT_FALSE(samples.contains("grpc_server_handling_seconds_count" + labels));
        EXPECT_EQ(sum_of(samples, "grpc_server_handled_total{", "grpc_method=\"Watch\""), 0);
        running.client.delete_session(id);
        EXPECT_FALSE(watcher.next());
    }
    const Samples samples = scrape_until(running.server.http_address(), ended, 1);
    EXPECT_EQ(samples.at("grpc_server_started_total" + labels), 1);
    EXPECT_EQ(samples.at("grpc_server_handling_seconds_count" + labels), 1);
    EXPECT_GT(samples.at("grpc_server_handling_seconds_sum" + labels), 0);
}

// Calls of methods that are not there make no new series.
TEST(Metrics, HaveOneSeriesForAllMethodsThatThereAreNot) {
    const Metrics::Method& unknown = known_method("/meniscus.v1.SurfaceService/Nonsense");
    EXPECT_EQ(unknown.name, "unknown");
    EXPECT_EQ(&known_method("/nonsense"), &unknown);
    EXPECT_EQ(&known_method(""), &unknown);
    EXPECT_EQ(known_method("/grpc.health.v1.Health/Watch").type, "server_stream");
    EXPECT_EQ(known_method("/meniscus.v1.RecordingService/DeleteRecording").type, "unary");
    EXPECT_EQ(known_method("/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo").type, "bidi_stream");
    RunningServer running(with_http());
    const auto calls = [&] {
        std::size_t series = 0;
        for (const auto& [name, value] : scrape(running.server.http_address()))
            series += name.starts_with("grpc_server_") ? 1 : 0;
        return series;
    };
    const auto call = [&](const std::string& method) {
        grpc::ClientContext context;
        const auto channel = grpc::CreateChannel(running.server.address(), grpc::InsecureChannelCredentials());
        std::promise<grpc::Status> status;
        const grpc::Slice nothing;
        const grpc::ByteBuffer request(&nothing, 1);
        grpc::ByteBuffer answer;
        grpc::GenericStub(channel).UnaryCall(&context, method, {}, &request, &answer,
                                             [&](grpc::Status s) { status.set_value(std::move(s)); });
        EXPECT_EQ(status.get_future().get().error_code(), grpc::StatusCode::UNIMPLEMENTED);
    };
    call("/meniscus.v1.SurfaceService/Nonsense0");
    const std::size_t before = calls();
    for (int i = 1; i < 4; ++i) call("/meniscus.v1.SurfaceService/Nonsense" + std::to_string(i));
    EXPECT_EQ(calls(), before);
}

TEST(Metrics, StateTheLimits) {
    ServerOptions options = with_http();
    options.limits.sessions = 5;
    options.limits.watchers_per_session = 6;
    options.limits.recording_readers = 9;
    options.limits.particles_per_frame = 7;
    options.limits.bytes_per_session = 8'000'000'000;
    options.limits.least_pace = {.time = std::chrono::milliseconds(1500), .bytes_per_second = 1000};
    options.limits.per_name.frames_per_second = 11;
    options.limits.work_per_frame = 12.5;
    const RunningServer running(options);
    const Samples samples = scrape(running.server.http_address());
    EXPECT_EQ(samples.at("meniscus_limit_number{limit=\"sessions\"}"), 5);
    EXPECT_EQ(samples.at("meniscus_limit_number{limit=\"watchers\"}"), 6);
    EXPECT_EQ(samples.at("meniscus_limit_number{limit=\"recording_readers\"}"), 9);
    EXPECT_EQ(samples.at("meniscus_limit_number{limit=\"particles_per_frame\"}"), 7);
    EXPECT_EQ(samples.at("meniscus_limit_bytes{limit=\"memory_per_session\"}"), 8'000'000'000);
    EXPECT_EQ(samples.at("meniscus_limit_seconds{limit=\"upload_time\"}"), 1.5);
    EXPECT_EQ(samples.at("meniscus_limit_upload_bytes_per_second"), 1000);
    EXPECT_EQ(samples.at("meniscus_limit_frames_per_second{limit=\"frames_per_second_per_name\"}"), 11);
    EXPECT_EQ(samples.at("meniscus_limit_frame_work_ratio"), 12.5);
}

// Each limit's metric has the name under which its refusals are counted.
TEST(Metrics, NameLimitsAsTheirRefusals) {
    const RunningServer running(with_http());
    const Samples samples = scrape(running.server.http_address());
    for (const LimitName limit : choices<LimitName>) {
        if (limit == LimitName::answer_time) continue;  // the same limit as upload_time
        const std::string label = "limit=\"" + std::string(name_of(limit)) + "\"";
        EXPECT_TRUE(std::ranges::any_of(samples, [&](const auto& sample) {
            return sample.first.starts_with("meniscus_limit_") && sample.first.find(label) != std::string::npos;
        })) << label;
    }
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
