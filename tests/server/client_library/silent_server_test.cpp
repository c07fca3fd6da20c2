// A server that was reached and answers nothing any more: no call waits for ever.
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <utility>
#include <vector>

#include "running_server.hpp"
#include "tcp_proxy.hpp"
#include "tcp_server.hpp"

namespace meniscus::server::test {
namespace {

using namespace std::chrono_literals;
using client::ErrorCode;

class SilentServer : public testing::Test {
protected:
    SilentServer() { proxy.swallow(); }

    static void expect_late(const char* name, const std::function<void()>& call) {
        try {
            call();
            ADD_FAILURE() << name << " was answered";
        } catch (const client::ServerError& error) {
            EXPECT_EQ(error.code(), ErrorCode::deadline_exceeded) << name << ": " << error.what();
            EXPECT_NE(std::string(error.what()).find("no answer within 50 ms"), std::string::npos) << error.what();
        }
    }

    RunningServer running{on_tcp()};
    const std::string id = running.session();
    TcpProxy proxy{port_of(running.server.address())};
    client::Client client{proxy.address(), {.timeout = 50ms, .wait = 60s}};  // to connect: as long as it takes
};

TEST_F(SilentServer, EndsEveryCallThatIsAnsweredOnce) {
    expect_late("server_info", [&] { client.server_info(); });
    expect_late("serving", [&] { client.serving(); });
    expect_late("create_session", [&] { client.create_session(client::new_session_id(), settings()); });
    expect_late("open_session", [&] { client.open_session(settings()); });
    expect_late("session", [&] { client.session(id); });
    expect_late("sessions", [&] { client.sessions(); });
    expect_late("delete_session", [&] { client.delete_session(id); });
    expect_late("snapshot", [&] { client.snapshot(id); });
    expect_late("recordings", [&] { client.recordings(); });
    expect_late("delete_recording", [&] { client.delete_recording(id, 1); });
    expect_late("stream, reconnecting", [&] { client.stream(id, {.reconnect = 60s}); });
}

TEST_F(SilentServer, EndsAWatcherThatIsNotAccepted) {
    expect_late("watch", [&] { client.watch(id).next(); });
    expect_late("watch_particles", [&] { client.watch_particles(id).next(); });
}

TEST_F(SilentServer, HoldsUpNoLimitedWait) {
    auto stream = client.stream(id);
    EXPECT_FALSE(stream.next(10ms));
    EXPECT_FALSE(stream.try_next().ended);
    auto reader = client.read_recording(id, 1);
    EXPECT_FALSE(reader.next(10ms));
    EXPECT_FALSE(reader.try_next().ended);
}

// gRPC holds up a writer there, canceled or not.
TEST(ServerThatReadsNothingMore, HoldsUpNoStreamThatIsLeft) {
    RunningServer running{on_tcp()};
    const std::string id = running.session();
    TcpProxy proxy{port_of(running.server.address())};
    client::Client client{proxy.address()};
    const std::vector<float> few(30, 0.0F);
    const std::vector<float> more_than_sockets_hold(std::size_t{3} << 22);
    ParticleFrame small;
    small.positions = few;
    ParticleFrame large;
    large.positions = more_than_sockets_hold;
    std::chrono::steady_clock::time_point left;
    {
        auto stream = client.stream(id);
        stream.push(small, 0, 0.0);
        ASSERT_TRUE(stream.next());
        proxy.stall();
        stream.push(large, 1, 0.0);
        stream.push(small, 2, 0.0);  // waits until the one before is on its way
        while (stream.try_push(small, 3, 0.0)) {
        }
        left = std::chrono::steady_clock::now();
    }
    EXPECT_LT(std::chrono::steady_clock::now() - left, 1s);
}

}  // namespace
}  // namespace meniscus::server::test
