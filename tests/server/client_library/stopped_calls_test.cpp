// Calls that are answered once, and the attempt to connect, end when their caller requests a stop.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <stop_token>
#include <string>

#include "running_server.hpp"
#include "tcp_proxy.hpp"
#include "tcp_server.hpp"

namespace meniscus::server::test {
namespace {

using namespace std::chrono_literals;
using client::ErrorCode;

using Call = std::function<void(const std::stop_token& stop)>;

void expect_canceled(const std::string& name, const std::function<void()>& call) {
    try {
        call();
        ADD_FAILURE() << name << " was not canceled";
    } catch (const client::ServerError& error) {
        EXPECT_EQ(error.code(), ErrorCode::canceled) << name << ": " << error.what();
    }
}

/// The call may begin before the stop or after it. Its own limit is hours away.
void expect_to_stop(const std::string& name, const Call& call) {
    std::stop_source stopping;
    std::promise<void> begins;
    auto stopped = std::async(std::launch::async, [&] {
        begins.set_value();
        expect_canceled(name, [&] { call(stopping.get_token()); });
    });
    begins.get_future().wait();
    stopping.request_stop();
    ASSERT_EQ(stopped.wait_for(60s), std::future_status::ready) << name;
}

TEST(StoppedCall, OfASilentServerEndsAsCanceled) {
    RunningServer running{on_tcp()};
    TcpProxy proxy{port_of(running.server.address())};
    client::Client client{proxy.address(), {.timeout = 2h}};
    const std::string id = running.session();
    auto session = client.open_session(settings());
    proxy.swallow();
    expect_to_stop("server_info", [&](const auto& stop) { client.server_info(stop); });
    expect_to_stop("serving", [&](const auto& stop) { client.serving(stop); });
    expect_to_stop("create_session", [&](const auto& stop) { client.create_session(id, settings(), {}, stop); });
    expect_to_stop("open_session", [&](const auto& stop) { client.open_session(settings(), {.stop = stop}); });
    expect_to_stop("session", [&](const auto& stop) { client.session(id, stop); });
    expect_to_stop("sessions", [&](const auto& stop) { client.sessions(stop); });
    expect_to_stop("delete_session", [&](const auto& stop) { client.delete_session(id, {}, stop); });
    expect_to_stop("snapshot", [&](const auto& stop) { client.snapshot(id, {.stop = stop}); });
    expect_to_stop("recordings", [&](const auto& stop) { client.recordings(stop); });
    expect_to_stop("delete_recording", [&](const auto& stop) { client.delete_recording(id, 1, stop); });
    expect_to_stop("stream, reconnecting",
                   [&](const auto& stop) { client.stream(id, {.reconnect = 60s, .stop = stop}); });
    expect_to_stop("info of a session", [&](const auto& stop) { session.info(stop); });
    expect_to_stop("stream of a session", [&](const auto& stop) { session.stream({.stop = stop}); });
    expect_to_stop("end of a session", [&](const auto& stop) { session.end(stop); });
    EXPECT_TRUE(session.is_owned());
}

TEST(StoppedCall, LeavesItsClientAndItsSessionUsable) {
    RunningServer running;
    auto session = running.client.open_session(settings());
    std::stop_source stopping;
    stopping.request_stop();
    expect_canceled("sessions", [&] { running.client.sessions(stopping.get_token()); });
    expect_canceled("info", [&] { session.info(stopping.get_token()); });
    EXPECT_EQ(running.client.sessions().size(), 1U);
    EXPECT_EQ(session.info().id, session.id());
    session.end();
    EXPECT_TRUE(running.client.sessions().empty());
}

TEST(StoppedCall, EndsTheAttemptToConnect) {
    expect_to_stop("a server that is not there yet", [](const auto& stop) {
        client::Client("unix:" + (std::filesystem::temp_directory_path() / "meniscus-test-nobody-listens").string(),
                       {.wait = 2h, .stop = stop});
    });
    RunningServer running{on_tcp()};
    TcpProxy proxy{port_of(running.server.address())};
    proxy.swallow();
    expect_to_stop("a server that does not answer",
                   [&](const auto& stop) { client::Client(proxy.address(), {.timeout = 2h, .stop = stop}); });
}

}  // namespace
}  // namespace meniscus::server::test
