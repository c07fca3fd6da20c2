// A frame's bytes are the same by native gRPC, by gRPC-Web, and by that through a real nginx, whose configuration has
// no more than the address.
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

#include "free_port.hpp"
#include "meniscus/v1/server_service.pb.h"
#include "meniscus/v1/surface_service.pb.h"
#include "running_server.hpp"
#include "test_certificates.hpp"
#include "web/web_call.hpp"

namespace meniscus::server::test {
namespace {

constexpr const char* program = "/usr/sbin/nginx";

class Nginx {
public:
    explicit Nginx(const std::string& target) {
        const std::string config = "daemon off; master_process off; error_log stderr crit; pid " + (folder_ / "pid") +
                                   ";\nevents {}\nhttp { access_log off; " + "client_body_temp_path " +
                                   (folder_ / "body") + "; proxy_temp_path " + (folder_ / "proxy") +
                                   "; fastcgi_temp_path " + (folder_ / "f") + "; uwsgi_temp_path " + (folder_ / "u") +
                                   "; scgi_temp_path " + (folder_ / "s") + ";\n  server {" + " listen " + address +
                                   "; location / { proxy_pass http://" + target + "; proxy_read_timeout 1h; } } }\n";
        const std::string file = folder_.write("nginx.conf", config);
        pid_ = ::fork();
        if (pid_ == 0) {
            ::execl(program, program, "-c", file.c_str(), nullptr);
            ::_exit(127);
        }
        const auto guard = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (std::chrono::steady_clock::now() < guard) try {
                const HttpClient probe(address);
                return;
            } catch (const std::runtime_error&) {
                std::this_thread::yield();
            }
        stop();
        throw std::runtime_error("nginx does not listen at " + address);
    }
    ~Nginx() { stop(); }
    Nginx(const Nginx&) = delete;
    Nginx& operator=(const Nginx&) = delete;

    const std::string address = "127.0.0.1:" + std::to_string(free_port());

private:
    void stop() const {
        ::kill(pid_, SIGTERM);
        ::waitpid(pid_, nullptr, 0);
    }

    TestFolder folder_;
    pid_t pid_ = -1;
};

v1::WatchRequest watch_request(const std::string& id) {
    v1::WatchRequest request;
    request.set_session_id(id);
    return request;
}

/// Sorted: bricks are sent as they are ready.
std::vector<std::string> web_frame(const std::string& http, const std::string& id) {
    WebCall call(http, "/meniscus.v1.SurfaceService/Watch", watch_request(id), {{"x-session-id", id}});
    std::vector<std::string> messages;
    while (auto message = call.next()) {
        messages.push_back(*message);
        v1::WatchResponse response;
        response.ParseFromString(*message);
        if (response.has_frame_statistics()) break;
    }
    std::ranges::sort(messages);
    return messages;
}

/// The frame's messages as they came, not as they would be written again.
std::vector<std::string> native_frame(const std::string& address, const std::string& id) {
    grpc::TemplatedGenericStub<v1::WatchRequest, grpc::ByteBuffer> stub(
        grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
    grpc::ClientContext context;
    client::add_session_id(context, id);
    grpc::CompletionQueue queue;
    void* tag = nullptr;
    bool ok = false;
    const auto call = stub.PrepareCall(&context, "/meniscus.v1.SurfaceService/Watch", &queue);
    const auto done = [&] { return queue.Next(&tag, &ok) && ok; };
    std::vector<std::string> messages;
    call->StartCall(&queue);
    done();
    call->WriteLast(watch_request(id), {}, &queue);
    done();
    for (grpc::ByteBuffer bytes; call->Read(&bytes, &queue), done();) {
        grpc::Slice message;
        if (!bytes.DumpToSingleSlice(&message).ok()) break;
        messages.emplace_back(reinterpret_cast<const char*>(message.begin()), message.size());
        v1::WatchResponse response;
        response.ParseFromString(messages.back());
        if (response.has_frame_statistics()) break;
    }
    context.TryCancel();
    grpc::Status status;
    call->Finish(&status, &queue);
    done();
    std::ranges::sort(messages);
    return messages;
}

v1::FrameStatistics statistics_of(const std::vector<std::string>& messages) {
    v1::WatchResponse response;
    for (const std::string& message : messages)
        if (response.ParseFromString(message) && response.has_frame_statistics()) return response.frame_statistics();
    return {};
}

void expect_same(const std::vector<std::string>& frame, const std::vector<std::string>& native) {
    EXPECT_EQ(frame.size(), native.size());
    EXPECT_EQ(statistics_of(frame).DebugString(), statistics_of(native).DebugString());
    EXPECT_TRUE(frame == native);
}

class AFrame : public testing::Test {
protected:
    AFrame() {
        stream.push(spray(6).view(), 0, 0.0);
        stream.next();
    }

    static ServerOptions web_options() {
        ServerOptions options = test_options();
        options.http = "127.0.0.1:0";
        return options;
    }

    RunningServer running{web_options()};
    const std::string id = running.session();
    /// Goes on while the frame is received: nothing waits for its end.
    client::Stream stream = running.client.stream(id, {.receive_meshes = false});
};

TEST_F(AFrame, HasTheSameBytesByNativeGrpcByGrpcWebAndThroughNginx) {
    // Encoded bricks are kept while somebody watches them; the statistics have the time that encoding took.
    client::Connection connection(running.server.address());
    grpc::ClientContext context;
    client::add_session_id(context, id);
    const auto keeps = connection.surfaces->Watch(&context, watch_request(id));
    v1::WatchResponse first;
    ASSERT_TRUE(keeps->Read(&first));
    const std::vector<std::string> native = native_frame(running.server.address(), id);
    ASSERT_GT(native.size(), 2U);
    {
        SCOPED_TRACE("gRPC-Web");
        expect_same(web_frame(running.server.http_address(), id), native);
    }
    if (::access(program, X_OK) != 0) GTEST_SKIP() << program << " is not there: without the third";
    const Nginx nginx(running.server.http_address());
    SCOPED_TRACE("nginx");
    expect_same(web_frame(nginx.address, id), native);
}

TEST_F(AFrame, IsNotAllThatNginxPassesOn) {
    if (::access(program, X_OK) != 0) GTEST_SKIP() << program << " is not there";
    const Nginx nginx(running.server.http_address());
    WebCall info(nginx.address, "/meniscus.v1.ServerService/GetServerInfo", v1::GetServerInfoRequest());
    EXPECT_TRUE(info.next());
    EXPECT_FALSE(info.next());
    EXPECT_EQ(info.status, 0);
    EXPECT_EQ(http_get(nginx.address, "/").status, 200);
}

}  // namespace
}  // namespace meniscus::server::test
