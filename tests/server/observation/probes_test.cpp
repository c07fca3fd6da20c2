// How orchestrators and tools see the server: health, readiness, reflection, channelz.
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "grpc/health/v1/health.grpc.pb.h"
#include "meniscus/error.hpp"
#include "observation/metrics.hpp"
#include "running_server.hpp"
#include "test_certificates.hpp"
#include "web/web_call.hpp"

namespace meniscus::server::test {
namespace {

TEST(Viewer, ThatNobodyAskedForIsNotMissedWhereItCannotBe) {
    ServerOptions options = test_options();
    options.http = "192.0.2.1:9464";  // of no machine
    options.insecure = true;
    EXPECT_THROW(Server{options}, Unavailable) << "somebody asked for it";
    options.http_is_default = true;
    RunningServer running(options);
    EXPECT_EQ(running.server.http_address(), "");
    EXPECT_EQ(running.client.sessions().size(), 0U);
}

using grpc::health::v1::Health;
using grpc::health::v1::HealthCheckRequest;
using grpc::health::v1::HealthCheckResponse;

HealthCheckRequest about(const std::string& service) {
    HealthCheckRequest request;
    request.set_service(service);
    return request;
}

/// A call of a service whose messages are not known here: wire bytes to wire bytes.
grpc::Status call(const client::Connection& connection, const std::string& method, const std::string& request,
                  std::string& response) {
    grpc::GenericStub stub(connection.channel);
    grpc::ClientContext context;
    const grpc::Slice slice(request);
    const grpc::ByteBuffer sent(&slice, 1);
    grpc::ByteBuffer received;
    std::promise<grpc::Status> status;
    stub.UnaryCall(&context, method, grpc::StubOptions(), &sent, &received,
                   [&](grpc::Status s) { status.set_value(std::move(s)); });
    grpc::Status result = status.get_future().get();
    grpc::Slice whole;
    if (result.ok() && received.DumpToSingleSlice(&whole).ok())
        response.assign(reinterpret_cast<const char*>(whole.begin()), whole.size());
    return result;
}

/// It is not even read which is meant: strangers may ask.
TEST(Probes, HealthIsThatOfTheServerWhateverServiceIsMeant) {
    const RunningServer running;
    const client::Connection connection(running.server.address());
    const auto stub = Health::NewStub(connection.channel);
    for (const char* service : {"", "meniscus.v1.ServerService", "meniscus.v1.SessionService",
                                "meniscus.v1.SurfaceService", "nobody.Service"}) {
        grpc::ClientContext context;
        HealthCheckResponse response;
        ASSERT_TRUE(stub->Check(&context, about(service), &response).ok()) << service;
        EXPECT_EQ(response.status(), HealthCheckResponse::SERVING) << service;
    }
}

TEST(Probes, TellOfDrainingWhileTheServerStillAnswers) {
    ServerOptions options = test_options();
    options.http = "127.0.0.1:0";
    RunningServer running(options);
    const std::string http = running.server.http_address();
    EXPECT_EQ(http_get(http, "/readyz").status, 200);
    const client::Connection connection(running.server.address());
    const auto stub = Health::NewStub(connection.channel);
    grpc::ClientContext context;
    const auto watch = stub->Watch(&context, about("meniscus.v1.SurfaceService"));
    HealthCheckResponse response;
    ASSERT_TRUE(watch->Read(&response));
    EXPECT_EQ(response.status(), HealthCheckResponse::SERVING);

    RawStream stream(running.server.address(), running.session());
    stream.send_begin(0, 4);  // the server waits for the rest of it
    stream.send_chunk(1);
    scrape_until(http, "meniscus_host_bytes{pool=\"frames_in_flight\"}", 48);
    std::thread stopping([&] { running.server.shutdown(); });
    ASSERT_TRUE(watch->Read(&response));
    EXPECT_EQ(response.status(), HealthCheckResponse::NOT_SERVING);
    const HttpAnswer ready = http_get(http, "/readyz");
    EXPECT_EQ(ready.status, 503);
    EXPECT_EQ(ready.body, "shutting down\n");
    EXPECT_EQ(http_get(http, "/healthz").status, 200);
    EXPECT_EQ(http_get(http, "/metrics").status, 200);
    stream.send_chunk(47);
    stream.send_end();
    stream.finish();
    // Though the watch goes on.
    stopping.join();
    EXPECT_FALSE(watch->Read(&response));
    EXPECT_FALSE(watch->Finish().ok());
    EXPECT_THROW(HttpClient{http}, std::runtime_error);
}

TEST(Probes, ReflectionAndChannelzAnswerOnlyIfChosen) {
    const std::string list_services("\x3a\x00", 2);
    ServerOptions options = test_options();
    options.reflection = options.channelz = true;
    const RunningServer open(options);
    const RunningServer closed;  // beside it in one process
    const client::Connection to_open(open.server.address());
    const client::Connection to_closed(closed.server.address());
    const std::string reflection = "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo";
    const std::string channelz = "/grpc.channelz.v1.Channelz/GetServers";
    std::string response;
    EXPECT_TRUE(call(to_open, reflection, list_services, response).ok());
    for (const char* service : {"meniscus.v1.ServerService", "meniscus.v1.SessionService", "meniscus.v1.SurfaceService",
                                "grpc.health.v1.Health"})
        EXPECT_NE(response.find(service), std::string::npos) << service;
    EXPECT_TRUE(call(to_open, channelz, {}, response).ok());
    EXPECT_FALSE(response.empty());
    EXPECT_EQ(call(to_closed, reflection, list_services, response).error_code(), grpc::StatusCode::UNIMPLEMENTED);
    EXPECT_EQ(call(to_closed, channelz, {}, response).error_code(), grpc::StatusCode::UNIMPLEMENTED);
}

/// Each of its calls holds a thread.
TEST(Probes, ReflectionCallsThatStayOpenAreBounded) {
    ServerOptions options = test_options();
    options.reflection = true;
    RunningServer running(options);
    const client::Connection connection(running.server.address());
    grpc::GenericStub stub(connection.channel);
    grpc::CompletionQueue queue;
    struct Call {
        grpc::ClientContext context;
        std::unique_ptr<grpc::GenericClientAsyncReaderWriter> stream;
        grpc::Status status;
    };
    std::vector<std::unique_ptr<Call>> calls;
    for (int i = 0; i < 40; ++i) {
        Call& call = *calls.emplace_back(std::make_unique<Call>());
        call.stream =
            stub.PrepareCall(&call.context, "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", &queue);
        call.stream->StartCall(nullptr);
        call.stream->Finish(&call.status, &call);
    }
    int refused = 0;
    void* tag = nullptr;
    bool ok = false;
    const auto guard = std::chrono::system_clock::now() + std::chrono::seconds(60);
    while (refused < 30) {
        ASSERT_EQ(queue.AsyncNext(&tag, &ok, guard), grpc::CompletionQueue::GOT_EVENT)
            << refused << " of 40 were refused";
        if (tag == nullptr) continue;
        EXPECT_EQ(static_cast<Call*>(tag)->status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
        ++refused;
    }
    // Nobody else notices, and the server ends with calls open.
    EXPECT_EQ(running.client.server_info().threads, 2U);
    running.server.shutdown();
    queue.Shutdown();
    while (queue.Next(&tag, &ok)) {
    }
}

TEST(Probes, HaveAPortOfTheirOwnThatStaysPlainAndHasNothingElse) {
    const TestCertificates certificates;
    ServerOptions options = test_options();
    options.tls = certificates.mutual_files();
    options.tokens = certificates.folder.write("tokens", "admin me " + std::string(64, 'a') + "\n");
    options.probes = "0.0.0.0:0";  // though it is not --insecure
    EXPECT_EQ(problems_of(options), std::vector<std::string>{});
    Server server(options);
    const std::string probes = "127.0.0.1" + server.probes_address().substr(7);
    EXPECT_EQ(http_get(probes, "/healthz").status, 200);
    EXPECT_EQ(http_get(probes, "/readyz").status, 200);
    EXPECT_EQ(scrape(probes).at("meniscus_sessions"), 0);
    EXPECT_EQ(http_get(probes, "/").status, 404);
    const std::string call = WebCall::request("/meniscus.v1.ServerService/GetServerInfo", web_message(""), {});
    HttpClient caller(probes);
    caller.send(call);
    EXPECT_EQ(caller.receive().status, 405);
    server.shutdown();
    EXPECT_THROW(HttpClient{probes}, std::runtime_error);
}

TEST(Probes, HttpNeedsALoopbackAddressUnlessToldOtherwise) {
    ServerOptions options = test_options();
    options.http = "0.0.0.0:0";
    EXPECT_THROW(Server{options}, InvalidInput);
    EXPECT_EQ(problems_of(options).size(), 1U);
    options.insecure = true;
    const Server server(options);
    EXPECT_EQ(http_get("127.0.0.1" + server.http_address().substr(7), "/readyz").status, 200);
}

}  // namespace
}  // namespace meniscus::server::test
