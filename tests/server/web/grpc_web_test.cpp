// Browsers' calls: the same answers as native gRPC gives, and what a browser would never send.
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <thread>

#include "meniscus/reconstructor.hpp"
#include "meniscus/v1/recording_service.pb.h"
#include "meniscus/v1/server_service.pb.h"
#include "meniscus/v1/session_service.pb.h"
#include "meniscus/v1/surface_service.pb.h"
#include "observation/metrics.hpp"
#include "running_server.hpp"
#include "test_certificates.hpp"
#include "test_folder.hpp"
#include "web/grpc_web.hpp"
#include "web/web_call.hpp"

namespace meniscus::server::test {
namespace {

const std::string info = "/meniscus.v1.ServerService/GetServerInfo";
const std::string get = "/meniscus.v1.SessionService/GetSession";
const std::string watch = "/meniscus.v1.SurfaceService/Watch";
const std::string list_recordings = "/meniscus.v1.RecordingService/ListRecordings";
const std::string read_recording = "/meniscus.v1.RecordingService/ReadRecording";

ServerOptions web_options() {
    ServerOptions options = test_options();
    options.http = "127.0.0.1:0";
    return options;
}

v1::WatchRequest watch_request(const std::string& id) {
    v1::WatchRequest request;
    request.set_session_id(id);
    return request;
}

v1::GetSessionRequest get_request(const std::string& id) {
    v1::GetSessionRequest request;
    request.set_id(id);
    return request;
}

void push_one(client::Client& client, const std::string& id, const Particles& particles, std::uint64_t index = 0) {
    auto stream = client.stream(id, {.receive_meshes = false});
    stream.push(particles.view(), index, 0.0);
    stream.finish();
    while (stream.next()) {
    }
}

std::vector<std::string> web_frame(WebCall& call) {
    std::vector<std::string> messages;
    while (auto message = call.next()) {
        messages.push_back(*message);
        v1::WatchResponse response;
        response.ParseFromString(*message);
        if (response.has_frame_statistics()) break;
    }
    return messages;
}

/// Waits for the session to have this number of watchers; a hang guard bounds it.
bool becomes(client::Client& client, const std::string& id, std::uint32_t watchers) {
    const auto guard = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (client.session(id).watchers != watchers) {
        if (std::chrono::steady_clock::now() > guard) return false;
        std::this_thread::yield();
    }
    return true;
}

class GrpcWebCalls : public testing::Test {
protected:
    RunningServer running{web_options()};
    const std::string id = running.session();
    const std::string http = running.server.http_address();

    WebCall::Headers about_session() const { return {{"x-session-id", id}}; }
};

TEST_F(GrpcWebCalls, AnswerUnaryCalls) {
    WebCall call(http, get, get_request(id), about_session());
    v1::GetSessionResponse response;
    ASSERT_TRUE(response.ParseFromString(call.next().value_or("")));
    EXPECT_EQ(response.session().id(), id);
    EXPECT_FALSE(call.next());
    EXPECT_EQ(call.status, 0);
}

TEST_F(GrpcWebCalls, AreToldTheCodecAndTheReason) {
    push_one(running.client, id, wave(6, 0.0));
    v1::WatchRequest request = watch_request(id);
    const WebCall from_older(http, watch, request, about_session());
    EXPECT_NE(from_older.header.find("x-codec: CODEC_DRACO\r\n"), std::string::npos) << from_older.header;
    request.add_codecs(v1::CODEC_LATTICE_PACKED);
    const WebCall call(http, watch, request, about_session());
    EXPECT_NE(call.header.find("x-codec: CODEC_LATTICE_PACKED\r\n"), std::string::npos) << call.header;
    EXPECT_NE(call.header.find("x-codec-reason: the first that the client names\r\n"), std::string::npos);
}

TEST_F(GrpcWebCalls, FollowOneAnotherOnOneConnection) {
    HttpClient client(http);
    for (int i = 0; i < 3; ++i) {
        const std::string body = web_message("");
        std::string request = "POST " + info;
        request +=
            " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/grpc-web\r\nContent-Length: 5\r\n\r\n" + body;
        client.send(request);
        std::string answer;
        while (!answer.ends_with("\r\n0\r\n\r\n")) {
            const std::string more = client.take();
            ASSERT_FALSE(more.empty()) << answer;
            answer += more;
        }
        EXPECT_NE(answer.find(std::string(version())), std::string::npos) << "no message";
        EXPECT_NE(answer.find("grpc-status: 0"), std::string::npos);
    }
    EXPECT_EQ(client.get("/healthz").status, 200);
}

TEST_F(GrpcWebCalls, EndWithTheStatusOfTheHandler) {
    const std::string unknown = client::new_session_id();
    WebCall missing(http, watch, watch_request(unknown), {{"x-session-id", unknown}});
    EXPECT_FALSE(missing.next());
    EXPECT_EQ(missing.status, static_cast<int>(grpc::StatusCode::NOT_FOUND));
    EXPECT_NE(missing.message.find(unknown), std::string::npos);

    WebCall without(http, watch, watch_request(id));
    EXPECT_FALSE(without.next());
    EXPECT_EQ(without.status, static_cast<int>(grpc::StatusCode::INVALID_ARGUMENT));

    WebCall twice(http, watch, watch_request(id), {{"x-session-id", id}, {"X-Session-Id", id}});
    EXPECT_FALSE(twice.next());
    EXPECT_NE(twice.message.find("more than once"), std::string::npos);
}

TEST_F(GrpcWebCalls, ReachOldProxiesThatSpeakHttp10) {
    WebCall call(http, info, v1::GetServerInfoRequest(), {}, "1.0");
    EXPECT_EQ(call.header.find("chunked"), std::string::npos);
    v1::GetServerInfoResponse response;
    ASSERT_TRUE(response.ParseFromString(call.next().value_or("")));
    EXPECT_FALSE(call.next());
    EXPECT_EQ(call.status, 0);
}

TEST_F(GrpcWebCalls, BringParticles) {
    const Particles particles = wave(4, 0.0);
    push_one(running.client, id, particles, 6);
    v1::WatchParticlesRequest request;
    request.set_session_id(id);
    WebCall call(http, "/meniscus.v1.SurfaceService/WatchParticles", request, about_session());
    v1::WatchParticlesResponse response;
    ASSERT_TRUE(response.ParseFromString(call.next().value_or("")));
    EXPECT_EQ(response.particles_begin().frame_index(), 6U);
    EXPECT_EQ(response.particles_begin().sent_count(), 64U);
    ASSERT_TRUE(response.ParseFromString(call.next().value_or("")));
    EXPECT_EQ(response.frame_chunk().data().size(), 64U * 6U);
    ASSERT_TRUE(response.ParseFromString(call.next().value_or("")));
    EXPECT_TRUE(response.has_frame_end());
    running.client.delete_session(id);
    EXPECT_FALSE(call.next());
    EXPECT_EQ(call.status, 0);
}

TEST(GrpcWebRecordings, AreTheBytesThatAWatcherGot) {
    const TestFolder folder;
    ServerOptions options = web_options();
    options.recording.directory = folder / "recordings";
    RunningServer running(options);
    const std::string id = running.session();
    const WebCall::Headers about_session{{"x-session-id", id}};
    v1::WatchRequest asked = watch_request(id);
    asked.add_codecs(v1::CODEC_LATTICE_ENTROPY);  // that of the recording
    WebCall watching(running.server.http_address(), watch, asked, about_session);
    push_one(running.client, id, wave(12, 0.0), 3);
    std::vector<std::string> watched = web_frame(watching);
    v1::ListRecordingsResponse list;
    const auto guard = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (list.recordings_size() == 0 || list.recordings(0).frames() == 0) {
        ASSERT_LT(std::chrono::steady_clock::now(), guard);
        WebCall call(running.server.http_address(), list_recordings, v1::ListRecordingsRequest());
        ASSERT_TRUE(list.ParseFromString(call.next().value_or("")));
    }
    v1::ReadRecordingRequest request;
    request.set_session_id(id);
    request.set_number(list.recordings(0).number());
    request.add_codecs(v1::CODEC_LATTICE_ENTROPY);
    WebCall reading(running.server.http_address(), read_recording, request, about_session);
    std::vector<std::string> read = web_frame(reading);
    EXPECT_FALSE(reading.next());
    EXPECT_EQ(reading.status, 0) << reading.message;
    EXPECT_GT(read.size(), 2U);
    // A watcher gets the bricks in the order that it asks for.
    std::sort(watched.begin(), watched.end());
    std::sort(read.begin(), read.end());
    EXPECT_EQ(read, watched);
}

TEST_F(GrpcWebCalls, EndWhenTheBrowserLeaves) {
    {
        WebCall call(http, watch, watch_request(id), about_session());
        ASSERT_TRUE(becomes(running.client, id, 1));
    }
    EXPECT_TRUE(becomes(running.client, id, 0));
}

TEST_F(GrpcWebCalls, EndWithTheirSessionAndSayWhy) {
    WebCall call(http, watch, watch_request(id), about_session());
    ASSERT_TRUE(becomes(running.client, id, 1));
    running.client.delete_session(id);
    while (call.next()) {
    }
    EXPECT_EQ(call.status, 0);
    EXPECT_EQ(call.session_end, "it was deleted");
}

TEST_F(GrpcWebCalls, EndWithTheServer) {
    WebCall call(http, watch, watch_request(id), about_session());
    ASSERT_TRUE(becomes(running.client, id, 1));
    running.server.shutdown();
    while (call.next()) {
    }
    EXPECT_EQ(call.status, static_cast<int>(grpc::StatusCode::UNAVAILABLE));
}

TEST_F(GrpcWebCalls, ThatAreNotReadDoNotHoldTheServerUp) {
    ServerOptions options = web_options();
    options.shutdown_grace = std::chrono::seconds(2);
    options.limits.watchers_per_session = 0;
    RunningServer hasty(options);
    const std::string session = hasty.session();
    std::vector<std::unique_ptr<WebCall>> calls(200);
    for (auto& call : calls)
        call = std::make_unique<WebCall>(hasty.server.http_address(), watch, watch_request(session),
                                         WebCall::Headers{{"x-session-id", session}});
    for (std::uint64_t i = 0; i < 10; ++i) push_one(hasty.client, session, spray(12), i);
    const auto start = std::chrono::steady_clock::now();
    hasty.server.shutdown();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST_F(GrpcWebCalls, ThatAreNotReadSkipToTheNewestFrame) {
    WebCall call(http, watch, watch_request(id), about_session());
    constexpr std::uint64_t skipped = 5;
    // The sockets hold few frames, however many are pushed. The limit ends the loop if a server skips none.
    constexpr std::uint64_t limit = 2000;
    std::uint64_t frames = 0;
    while (running.client.session(id).frames_skipped < skipped && frames < limit) {
        push_one(running.client, id, wave(40, 0.1 * static_cast<double>(frames)), frames);
        ++frames;
    }
    std::uint64_t received = 0;
    std::uint64_t last = 0;
    while (last + 1 < frames) {
        const std::vector<std::string> messages = web_frame(call);
        ASSERT_FALSE(messages.empty());
        v1::WatchResponse response;
        ASSERT_TRUE(response.ParseFromString(messages.back()));
        last = response.frame_statistics().frame_index();
        ++received;
    }
    EXPECT_LE(received + skipped, frames);
    std::cout << received << " of " << frames << " frames received\n";
}

TEST_F(GrpcWebCalls, AreReadOnly) {
    for (const char* method : {"/meniscus.v1.SessionService/CreateSession", "/meniscus.v1.SessionService/DeleteSession",
                               "/meniscus.v1.SurfaceService/Stream", "/meniscus.v1.SurfaceService/watch"}) {
        WebCall call(http, method, get_request(id), about_session());
        EXPECT_FALSE(call.next()) << method;
        EXPECT_EQ(call.status, static_cast<int>(grpc::StatusCode::UNIMPLEMENTED)) << method;
    }
    EXPECT_EQ(running.client.session(id).id, id);
}

TEST(GrpcWeb, ServesExactlyTheMethodsWithoutSideEffects) {
    const GrpcWeb web{.channel = grpc::CreateChannel("unix:none", grpc::InsecureChannelCredentials()), .origins = {}};
    std::set<std::string> served;
    std::set<std::string> streams;
    for (const auto* message : {v1::ListRecordingsRequest::descriptor(), v1::GetServerInfoRequest::descriptor(),
                                v1::GetSessionRequest::descriptor(), v1::WatchRequest::descriptor()}) {
        const auto* service = message->file()->service(0);
        for (int i = 0; i < service->method_count(); ++i) {
            const std::string target = "/" + service->full_name() + "/" + service->method(i)->name();
            EXPECT_TRUE(is_method(target)) << target;
            if (web.serves(target)) served.insert(target);
            if (is_stream(target)) streams.insert(target);
        }
    }
    const std::string watch_particles = "/meniscus.v1.SurfaceService/WatchParticles";
    const std::string list = "/meniscus.v1.SessionService/ListSessions";
    const std::string snapshot = "/meniscus.v1.SurfaceService/Snapshot";
    EXPECT_EQ(served, (std::set<std::string>{list_recordings, read_recording, info, get, list, snapshot, watch,
                                             watch_particles}));
    EXPECT_EQ(streams, (std::set<std::string>{read_recording, snapshot, watch, watch_particles}));
    EXPECT_FALSE(GrpcWeb{}.serves(info)) << "without a channel";
}

TEST_F(GrpcWebCalls, EndAtTheirDeadline) {
    WebCall late(http, watch, watch_request(id), {{"x-session-id", id}, {"grpc-timeout", "50m"}});
    EXPECT_FALSE(late.next());
    EXPECT_EQ(late.status, static_cast<int>(grpc::StatusCode::DEADLINE_EXCEEDED));
    EXPECT_TRUE(becomes(running.client, id, 0));
    for (const char* wrong : {"", "m", "1", "123456789m", "1.5S", "-1S", "+1S"}) {
        WebCall call(http, info, v1::GetServerInfoRequest(), {{"grpc-timeout", wrong}});
        EXPECT_FALSE(call.next());
        EXPECT_EQ(call.status, static_cast<int>(grpc::StatusCode::INVALID_ARGUMENT)) << wrong;
    }
}

TEST_F(GrpcWebCalls, NeedATokenWhereOneIsNeeded) {
    const TestFolder folder;
    ServerOptions options = web_options();
    options.tokens = folder.write("tokens", "watcher eve token-of-eve-0123456789\n");
    const Server server(options);
    WebCall without(server.http_address(), info, v1::GetServerInfoRequest());
    EXPECT_FALSE(without.next());
    EXPECT_EQ(without.status, static_cast<int>(grpc::StatusCode::UNAUTHENTICATED));
    WebCall with(server.http_address(), info, v1::GetServerInfoRequest(),
                 {{"Authorization", "Bearer token-of-eve-0123456789"}});
    EXPECT_TRUE(with.next());
}

struct BadRequest {
    std::string name;
    std::string request;
    int status;
    std::string words;
};

std::vector<BadRequest> bad_requests() {
    const auto post = [](const std::string& fields, const std::string& body) {
        return "POST " + info + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n" + body;
    };
    const std::string type = "Content-Type: application/grpc-web+proto\r\n";
    const auto sized = [&](const std::string& body) {
        return post(type + "Content-Length: " + std::to_string(body.size()) + "\r\n", body);
    };
    const std::string invalid = "grpc-status: 3\r\ngrpc-message: ";
    const std::string exhausted = "grpc-status: 8\r\ngrpc-message: ";
    std::string chunks;
    for (int i = 0; i < 65; ++i) chunks += "1\r\nx\r\n";
    return {
        {"no content type", post("Content-Length: 5\r\n", web_message("")), 415, "application/grpc-web+proto is taken"},
        {"text", post("Content-Type: application/grpc-web-text\r\nContent-Length: 5\r\n", web_message("")), 415,
         "grpc-web-text"},
        {"no body", post(type, ""), 200, invalid + "the body has 0 bytes"},
        {"half a header", sized(std::string(3, '\0')), 200,
         invalid + "the body has 3 bytes; a gRPC-Web message has at least 5"},
        {"compressed", sized(web_message("", 1)), 200, "grpc-status: 12\r\ngrpc-message: the message is compressed"},
        {"trailers", sized(web_message("", '\x80')), 200, invalid + "the message has the flags 128"},
        {"less than announced", sized(web_message("abc").substr(0, 6)), 200,
         invalid + "the message announces 3 bytes, but 1 follow"},
        {"two messages", sized(web_message("") + web_message("")), 200,
         invalid + "the message announces 0 bytes, but 5 follow"},
        {"too large", post(type + "Content-Length: 65537\r\n", ""), 200,
         exhausted + "the request has 65537 bytes; at most 65536"},
        {"too many chunks", post(type + "Transfer-Encoding: chunked\r\n", chunks), 200,
         exhausted + "the request has more than"},
        {"no chunk", post(type + "Transfer-Encoding: chunked\r\n", "zz\r\n"), 400, "no HTTP body"},
        {"endless trailers", post(type + "Transfer-Encoding: chunked\r\n", "0\r\nX: " + std::string(40000, 'x')), 400,
         "no HTTP body"},
        {"two lengths", post(type + "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n", "0\r\n\r\n"), 400,
         "no HTTP request"},
        {"control character", post(type + "Authorization: Bearer \x80\r\nContent-Length: 5\r\n", web_message("")), 200,
         invalid + "the header authorization has characters"},
        {"two hosts", post("Host: localhost\r\n" + type, ""), 400, "more than one host"},
        {"read by GET", "GET " + info + " HTTP/1.1\r\nHost: localhost\r\n\r\n", 405, "POST is"},
        {"foreign page", post(type + "Origin: https://evil.example\r\nContent-Length: 5\r\n", web_message("")), 403,
         "https://evil.example"},
    };
}

TEST_F(GrpcWebCalls, AreRefusedInWordsWhenTheyAreWrongAndHarmNobody) {
    WebCall healthy(http, watch, watch_request(id), about_session());
    for (const BadRequest& bad : bad_requests()) {
        HttpClient client(http);
        client.send(bad.request);
        const HttpAnswer answer = client.receive();
        EXPECT_EQ(answer.status, bad.status) << bad.name;
        EXPECT_NE(answer.body.find(bad.words), std::string::npos) << bad.name << ": " << answer.body;
    }
    push_one(running.client, id, wave(6, 0.0));
    EXPECT_GT(web_frame(healthy).size(), 2U);
}

TEST_F(GrpcWebCalls, ThatAreRefusedBeforeTheirHandlerAreCountedToo) {
    const auto rises = [&](const std::string& code, const std::string& request, const std::string& method) {
        const auto calls = [&](const char* name, const std::string& label) {
            return sum_of(scrape(http), name, label + "grpc_method=\"" + method + "\"");
        };
        const std::string with_code = "grpc_code=\"" + code + "\",";
        const double before = calls("grpc_server_handled_total{", with_code);
        const double started = calls("grpc_server_started_total{", "");
        HttpClient client(http);
        client.send(request);
        client.receive();
        EXPECT_EQ(calls("grpc_server_handled_total{", with_code), before + 1) << request;
        EXPECT_EQ(calls("grpc_server_started_total{", ""), started + 1) << request;
    };
    const std::string head = " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/grpc-web+proto\r\n";
    const std::string body = "Content-Length: 5\r\n\r\n" + web_message("");
    const char* const method = "GetServerInfo";
    rises("PermissionDenied", "POST " + info + head + "Origin: https://evil.example\r\n" + body, method);
    rises("Unimplemented", "POST /meniscus.v1.SessionService/DeleteSession" + head + body, "DeleteSession");
    rises("Unimplemented", "POST /meniscus.v1.SessionService/Nonsense" + head + body, "unknown");
    rises("ResourceExhausted", "POST " + info + head + "Content-Length: 65537\r\n\r\n", method);
    rises("InvalidArgument", "POST " + info + head + "Content-Length: 3\r\n\r\n" + std::string(3, '\0'), method);
    rises("InvalidArgument", "GET " + info + head + "\r\n", method);
    rises("InvalidArgument", "POST " + info + " HTTP/1.1\r\nHost: elsewhere.example\r\n\r\n", method);
}

TEST_F(GrpcWebCalls, AreTakenInChunks) {
    HttpClient client(http);
    client.send("POST " + info +
                " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nContent-Type: application/grpc-web+proto\r\n"
                "Transfer-Encoding: chunked\r\n\r\n2\r\n" +
                std::string(2, '\0') + "\r\n3\r\n" + std::string(3, '\0') + "\r\n0\r\n\r\n");
    EXPECT_EQ(client.receive().status, 200);
}

/// A page of evil.example, whose name its DNS has turned to this machine, is the server's own page to the browser.
TEST_F(GrpcWebCalls, AreNotMadeByPagesThatTookTheServersAddress) {
    const auto ask = [&](const std::string& start) {
        HttpClient client(http);
        client.send(
            start +
            " HTTP/1.1\r\nHost: evil.example:9464\r\nOrigin: http://evil.example:9464\r\nContent-Length: 0\r\n\r\n");
        return client.receive();
    };
    for (const std::string& start : {"POST " + watch, "OPTIONS " + watch, std::string("GET /")}) {
        const HttpAnswer answer = ask(start);
        EXPECT_EQ(answer.status, 421) << start;
        EXPECT_NE(answer.body.find("evil.example"), std::string::npos) << answer.body;
        EXPECT_EQ(answer.header.find("Allow-Origin"), std::string::npos) << answer.header;
    }
    EXPECT_EQ(ask("GET /healthz").status, 200) << "probes may know the server by any name";
}

TEST_F(GrpcWebCalls, AreAnnouncedToPagesThatMayMakeThem) {
    HttpClient client(http);
    client.send(
        "OPTIONS " + watch +
        " HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost:5173\r\nAccess-Control-Request-Method: POST\r\n\r\n");
    const HttpAnswer answer = client.receive();
    EXPECT_EQ(answer.status, 204);
    EXPECT_NE(answer.header.find("Access-Control-Allow-Origin: http://localhost:5173"), std::string::npos);
    EXPECT_NE(answer.header.find("x-session-id"), std::string::npos);
}

}  // namespace
}  // namespace meniscus::server::test
