// Whole runs of the load generator.
#include "load/load.hpp"

#include <gtest/gtest.h>

#include <grpcpp/create_channel.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "load/report.hpp"
#include "meniscus/v1/server_service.grpc.pb.h"
#include "process.hpp"

namespace meniscus::load {
namespace {

using server::test::on_free_port;
using server::test::Process;

LoadOptions small(const std::string& server) {
    LoadOptions options;
    options.server.address = server;
    options.particles = 200;
    options.rate = 50.0;
    options.seconds = 0.6;
    options.warm_up = 0.2;
    return options;
}

/// Waits until the only session of a run has reached the frame.
void wait_for_frame(std::uint64_t index, Process& server, const std::string& address) {
    client::Client client(address);
    auto watcher = client.watch(server.created_session());
    while (const auto frame = watcher.next())
        if (frame->index >= index) return;
    ADD_FAILURE() << "the run ended before frame " << index;
}

/// Calls a server that stands still: the call ends at its deadline.
void wait_in_vain(const std::string& address, std::chrono::milliseconds time) {
    const auto stub = v1::ServerService::NewStub(grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + time);
    v1::GetServerInfoResponse response;
    EXPECT_EQ(stub->GetServerInfo(&context, {}, &response).error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
}

TEST(Load, CountsWhatAllOfItsClientsSee) {
    Process process(on_free_port());
    LoadOptions options = small(process.address());
    options.simulators = 2;
    options.watchers = 2;
    options.slow = 1;
    options.slow_seconds = 0.01;
    options.stalled = 1;
    options.vanishing = 1;
    options.vanish_after = 3;
    const LoadResult result = run_load(options);
    EXPECT_EQ(result.uploads.answered + result.uploads.not_sent, 60U);
    EXPECT_EQ(result.uploads.lost(), 0U);
    EXPECT_EQ(result.uploads.upload_bytes, result.uploads.sent * 200 * 12);
    EXPECT_LE(result.uploads.answer.count(), 40U);
    EXPECT_EQ(result.watchers.frames + result.watchers.skipped, 2 * result.uploads.answered);
    EXPECT_GT(result.slow.frames, 0U);
    EXPECT_GT(result.vanishing.vanished, 0U);
    EXPECT_FALSE(has_failures(result)) << to_table(result);
}

TEST(Load, MeasuresFromWhenAFrameWasDueAlsoOnAServerThatStalls) {
    Process process(on_free_port());
    LoadOptions options = small(process.address());
    options.warm_up = 0.0;
    options.seconds = 0.8;
    // The server stands still for 0.4 s: frames due in that time waited for it, whenever they were sent.
    std::thread stalling([&] {
        wait_for_frame(10, process, options.server.address);
        process.stop();
        wait_in_vain(options.server.address, std::chrono::milliseconds(400));
        process.signal(SIGCONT);
    });
    const LoadResult result = run_load(options);
    stalling.join();
    // Half of the frames fall into the stall; they waited for 0.2 s in the mean.
    EXPECT_GT(result.uploads.answer.mean(), 0.05);
    EXPECT_GT(result.uploads.answer.percentile(0.99), 0.3);
    EXPECT_EQ(result.uploads.lost(), 0U);
}

TEST(Load, CountsWhatAPolicyDrops) {
    Process process(on_free_port());
    LoadOptions options = small(process.address());
    options.stream.policy = client::UploadPolicy::every_nth;
    options.stream.nth = 3;
    const LoadResult result = run_load(options);
    EXPECT_EQ(result.uploads.answered, (result.uploads.sent + 2) / 3);
    EXPECT_EQ(result.uploads.dropped, result.uploads.sent - result.uploads.answered);
    EXPECT_FALSE(has_failures(result)) << to_table(result);
}

TEST(Load, ReportsFailuresByStatus) {
    Process process(on_free_port({"--max-particles", "199"}));
    const LoadOptions options = small(process.address());
    const LoadResult result = run_load(options);
    EXPECT_TRUE(has_failures(result));
    const nlohmann::json json = nlohmann::json::parse(to_json(options, result));
    EXPECT_EQ(json.at("upload_errors").at("RESOURCE_EXHAUSTED"), 1);
    EXPECT_EQ(json.at("frames").at("answered"), 0);
}

TEST(Load, ReportsAServerThatGoesAwayAndEnds) {
    Process process(on_free_port());
    LoadOptions options = small(process.address());
    options.seconds = 5.0;
    std::thread killing([&] {
        wait_for_frame(25, process, options.server.address);
        process.signal(SIGKILL);
    });
    const LoadResult result = run_load(options);
    killing.join();
    EXPECT_EQ(result.uploads.errors.count("UNAVAILABLE"), 1U) << to_table(result);
    EXPECT_GT(result.uploads.not_sent, 0U);
}

TEST(Load, ReportsAllFiguresAsJson) {
    Process process(on_free_port());
    const LoadOptions options = small(process.address());
    const nlohmann::json json = nlohmann::json::parse(to_json(options, run_load(options)));
    for (const char* figure : {"due_to_answer_seconds", "due_to_send_seconds"})
        for (const char* percentile : {"count", "mean", "p50", "p90", "p99", "p99.9", "max"})
            EXPECT_GE(json.at(figure).at(percentile).get<double>(), 0.0) << figure << percentile;
    EXPECT_GT(json.at("watchers").at("due_to_watcher_seconds").at("p50").get<double>(), 0.0);
    EXPECT_GT(json.at("throughput").at("frames_per_second").get<double>(), 0.0);
}

}  // namespace
}  // namespace meniscus::load
