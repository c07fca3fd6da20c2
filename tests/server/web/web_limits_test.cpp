// Streams and connections of the HTTP port: bounded, and nobody's stream is another one's room.
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/v1/server_service.pb.h"
#include "meniscus/v1/surface_service.pb.h"
#include "running_server.hpp"
#include "web/http_server.hpp"
#include "web/web_call.hpp"

namespace meniscus::server::test {
namespace {

const std::string watch = "/meniscus.v1.SurfaceService/Watch";

class WebLimits : public testing::Test {
protected:
    WebCall watch_call() const {
        v1::WatchRequest request;
        request.set_session_id(id);
        return {http.address(), watch, request, {{"x-session-id", id}}};
    }

    static Router router() {
        Router router;
        router.add("/healthz", [] { return Page{.body = "alive\n"}; });
        return router;
    }
    GrpcWeb calls() const {
        return {.channel = grpc::CreateChannel(running.server.address(), grpc::InsecureChannelCredentials()),
                .origins = {}};
    }

    RunningServer running;
    const std::string id = running.session();
    HttpServer http{
        "127.0.0.1:0", router(), calls(), {.connections = 6, .streams = 3, .patience = std::chrono::hours(1)}};
};

TEST_F(WebLimits, AStreamTooManyIsRefusedInWordsAndTheOthersGoOn) {
    std::array<WebCall, 3> streams{watch_call(), watch_call(), watch_call()};
    WebCall fourth = watch_call();
    EXPECT_FALSE(fourth.next());
    EXPECT_EQ(fourth.status, static_cast<int>(grpc::StatusCode::RESOURCE_EXHAUSTED));
    EXPECT_NE(fourth.message.find("3 streams"), std::string::npos) << fourth.message;
    running.client.delete_session(id);
    for (WebCall& stream : streams) {
        while (stream.next()) {
        }
        EXPECT_EQ(stream.status, 0);
    }
}

TEST_F(WebLimits, WhoConnectsAndIsSilentTakesNobodysStream) {
    WebCall stream = watch_call();
    std::vector<std::unique_ptr<HttpClient>> silent;
    for (int i = 0; i < 50; ++i) {
        silent.push_back(std::make_unique<HttpClient>(http.address()));
        ASSERT_EQ(http_get(http.address(), "/healthz").status, 200) << i;
    }
    running.client.delete_session(id);
    EXPECT_FALSE(stream.next());
    EXPECT_EQ(stream.status, 0);
}

TEST(WebPatience, ALargeAnswerThatNobodyTakesIsForgottenAsSoonAsASmallOne) {
    std::promise<void> forgotten;
    std::future<void> end = forgotten.get_future();
    Router router;
    router.add("/large", [&] {
        constexpr std::size_t more_than_a_socket_holds = std::size_t{64} << 20;
        Page page{.body = std::string(more_than_a_socket_holds, 'x')};
        page.memory = std::shared_ptr<void>(nullptr, [&](void*) { forgotten.set_value(); });
        return page;
    });
    // A client that goes on taking it would have two years.
    const HttpServer http{
        "127.0.0.1:0", std::move(router), {}, {.patience = std::chrono::milliseconds(100), .bytes_per_second = 1}};
    HttpClient client(http.address());
    client.send("GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(end.wait_for(std::chrono::seconds(30)), std::future_status::ready);
}

}  // namespace
}  // namespace meniscus::server::test
