// Calls with one request: as gRPC's own clients never make them.
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "observation/metrics.hpp"
#include "raw_call.hpp"
#include "rpc/calls/one_request.hpp"
#include "running_server.hpp"
#include "test_folder.hpp"

namespace meniscus::server::test {
namespace {

constexpr const char* methods[] = {
    "/meniscus.v1.ServerService/GetServerInfo",    "/meniscus.v1.SessionService/CreateSession",
    "/meniscus.v1.SessionService/GetSession",      "/meniscus.v1.SessionService/ListSessions",
    "/meniscus.v1.SessionService/DeleteSession",   "/meniscus.v1.SurfaceService/Watch",
    "/meniscus.v1.SurfaceService/WatchParticles",  "/meniscus.v1.RecordingService/ListRecordings",
    "/meniscus.v1.RecordingService/ReadRecording", "/meniscus.v1.RecordingService/DeleteRecording",
};

/// The id of a session that is not there.
constexpr const char* no_session = "00000000-0000-4000-8000-000000000000";

/// A server that has every call, and its metrics.
struct OneRequest : testing::Test {
    ServerOptions options() const {
        ServerOptions options = test_options();
        options.http = "127.0.0.1:0";
        options.recording.directory = folder / "recordings";
        return options;
    }

    const TestFolder folder;
    RunningServer running{options()};
    const client::Connection connection{running.server.address()};
};

TEST_F(OneRequest, ThatNeverComesIsRefusedInWords) {
    for (const char* method : methods) {
        RawCall call(connection, method, no_session);
        call.send_no_more();
        const grpc::Status status = call.end();
        EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << method;
        EXPECT_EQ(status.error_message(), "the call ended before its request: send one message") << method;
    }
}

TEST_F(OneRequest, HasALimit) {
    for (const char* method : methods) {
        RawCall call(connection, method, no_session);
        call.send(std::string(max_request_bytes + 1, '\0'));
        const grpc::Status status = call.end();
        EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << method;
        EXPECT_EQ(status.error_message(), "the request has 65537 bytes; at most 65536 are taken") << method;
    }
}

TEST_F(OneRequest, MayBeAsLargeAsItsLimit) {
    std::string field = "\xfa\x7f\xfb\xff\x03";  // a field that no version knows, and its 65531 bytes
    field.resize(max_request_bytes, 'x');
    RawCall call(connection, "/meniscus.v1.SessionService/ListSessions", no_session);
    call.send(field);
    const grpc::Status status = call.end();
    EXPECT_TRUE(status.ok()) << status.error_message();
}

TEST_F(OneRequest, ThatIsLargerThanAnyMessageIsRefused) {
    for (const char* method : methods) {
        RawCall call(connection, method, no_session);
        call.send(std::string(std::size_t{5} << 20U, '\0'));
        EXPECT_EQ(call.end().error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << method;
    }
}

TEST_F(OneRequest, NeedNotComeWhereTheCallIsCanceled) {
    std::vector<std::unique_ptr<RawCall>> calls;
    for (const char* method : methods) calls.push_back(std::make_unique<RawCall>(connection, method, no_session));
    // Behind them on the same connection: its answer shows that they have begun.
    RawCall last(connection, methods[0], no_session);
    last.send(std::string());
    EXPECT_TRUE(last.end().ok());
    for (const auto& call : calls) call->cancel();
    for (const auto& call : calls) EXPECT_EQ(call->end().error_code(), grpc::StatusCode::CANCELLED);
    Samples samples;
    do samples = scrape(running.server.http_address());
    while (calls_ended(samples, "Canceled") != static_cast<double>(std::size(methods)));
    for (const auto& [sample, value] : samples)
        EXPECT_FALSE(sample.starts_with("meniscus_refusals_total")) << sample << " " << value;
}

TEST_F(OneRequest, ThatDoesNotComeHoldsNoServerUp) {
    std::vector<std::unique_ptr<RawCall>> calls;
    for (const char* method : methods) calls.push_back(std::make_unique<RawCall>(connection, method, no_session));
    const auto begin = std::chrono::steady_clock::now();
    running.server.shutdown();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
    for (const auto& call : calls) EXPECT_FALSE(call->end().ok());
}

}  // namespace
}  // namespace meniscus::server::test
