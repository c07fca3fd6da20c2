// Calls with one request: as gRPC's own clients never make them.
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "observation/metrics.hpp"
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

/// A call that has begun; its request is up to the test.
class OpenCall {
public:
    OpenCall(const client::Connection& connection, const char* method) : stub_(connection.channel) {
        client::add_session_id(context_, "00000000-0000-4000-8000-000000000000");
        call_ = stub_.PrepareCall(&context_, method, &queue_);
        call_->StartCall(this);
        wait();
    }

    void send(const std::string& bytes) {
        const grpc::Slice slice(bytes);
        call_->WriteLast({&slice, 1}, {}, this);
        wait();
    }
    void send_no_more() {
        call_->WritesDone(this);
        wait();
    }
    void cancel() { context_.TryCancel(); }
    grpc::Status end() {
        grpc::ByteBuffer message;
        do call_->Read(&message, this);
        while (wait());
        grpc::Status status;
        call_->Finish(&status, this);
        wait();
        return status;
    }

private:
    bool wait() {
        void* tag = nullptr;
        bool ok = false;
        return queue_.Next(&tag, &ok) && ok;
    }

    grpc::GenericStub stub_;
    grpc::ClientContext context_;
    grpc::CompletionQueue queue_;
    std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
};

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
        OpenCall call(connection, method);
        call.send_no_more();
        const grpc::Status status = call.end();
        EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << method;
        EXPECT_EQ(status.error_message(), "the call ended before its request: send one message") << method;
    }
}

TEST_F(OneRequest, HasALimit) {
    for (const char* method : methods) {
        OpenCall call(connection, method);
        call.send(std::string(max_request_bytes + 1, '\0'));
        const grpc::Status status = call.end();
        EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << method;
        EXPECT_EQ(status.error_message(), "the request has 65537 bytes; at most 65536 are taken") << method;
    }
}

TEST_F(OneRequest, MayBeAsLargeAsItsLimit) {
    std::string field = "\xfa\x7f\xfb\xff\x03";  // a field that no version knows, and its 65531 bytes
    field.resize(max_request_bytes, 'x');
    OpenCall call(connection, "/meniscus.v1.SessionService/ListSessions");
    call.send(field);
    const grpc::Status status = call.end();
    EXPECT_TRUE(status.ok()) << status.error_message();
}

TEST_F(OneRequest, ThatIsLargerThanAnyMessageIsRefused) {
    for (const char* method : methods) {
        OpenCall call(connection, method);
        call.send(std::string(std::size_t{5} << 20U, '\0'));
        EXPECT_EQ(call.end().error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << method;
    }
}

TEST_F(OneRequest, NeedNotComeWhereTheCallIsCanceled) {
    std::vector<std::unique_ptr<OpenCall>> calls;
    for (const char* method : methods) calls.push_back(std::make_unique<OpenCall>(connection, method));
    // Behind them on the same connection: its answer shows that they have begun.
    OpenCall last(connection, methods[0]);
    last.send({});
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
    std::vector<std::unique_ptr<OpenCall>> calls;
    for (const char* method : methods) calls.push_back(std::make_unique<OpenCall>(connection, method));
    const auto begin = std::chrono::steady_clock::now();
    running.server.shutdown();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
    for (const auto& call : calls) EXPECT_FALSE(call->end().ok());
}

}  // namespace
}  // namespace meniscus::server::test
