// Servers that are killed and started again, as streams and watchers see it. In a process of their own: threads of a
// server in this one would notice for the client what its own calls do not.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <future>
#include <optional>
#include <thread>
#include <vector>

#include "free_port.hpp"
#include "meniscus/client/client.hpp"
#include "process.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr std::chrono::seconds patient{60};

struct Returns {
    std::vector<double> stream;   ///< seconds from when the server listened until a frame was answered
    std::vector<double> watcher;  ///< until a watcher had it
};

/// A simulator and a watcher, while their server is killed and comes back after each of these outages.
Returns return_times(const std::string& address, const std::vector<std::chrono::milliseconds>& outages) {
    const std::vector<std::string> arguments{"--listen", address, "--threads", "1"};
    std::optional<Process> server(std::in_place, arguments);
    server->address();
    client::Client client(address);
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    auto stream = client.stream(id, {.reconnect = patient});
    auto watcher = client.watch(id, {.reconnect = patient});
    const Particles particles = wave(4, 0.0);
    stream.push(particles.view(), 0, 0.0);
    EXPECT_TRUE(stream.next());
    EXPECT_TRUE(watcher.next());
    Returns returns;
    for (std::uint64_t frame = 1; frame <= outages.size(); ++frame) {
        auto shown = std::async(std::launch::async, [&] {
            const auto next = watcher.next();
            return std::pair(next ? next->index : 0, Clock::now());
        });
        server->signal(frame % 2 == 0 ? SIGTERM : SIGKILL);
        server->exit_code();
        std::this_thread::sleep_for(outages[frame - 1]);
        server.emplace(arguments);
        server->address();
        const auto back = Clock::now();
        stream.push(particles.view(), frame, 0.0);
        EXPECT_TRUE(stream.next());
        returns.stream.push_back(Seconds(Clock::now() - back).count());
        const auto [index, at] = shown.get();
        EXPECT_EQ(index, frame);
        returns.watcher.push_back(Seconds(at - back).count());
    }
    return returns;
}

void expect_soon(std::vector<double> seconds) {
    std::sort(seconds.begin(), seconds.end());
    EXPECT_LT(seconds[seconds.size() / 2], 0.5 * 5);
    EXPECT_LT(seconds.back(), 1.5 * 5);
    for (const double each : seconds) testing::Test::RecordProperty("seconds", std::to_string(each));
}

TEST(Restart, BringsStreamsAndWatchersBackSoonAfterTheServer) {
    using std::chrono::milliseconds;
    const Returns returns =
        return_times("127.0.0.1:" + std::to_string(free_port()),
                     {milliseconds(100), milliseconds(400), milliseconds(1000), milliseconds(200), milliseconds(2000)});
    expect_soon(returns.stream);
    expect_soon(returns.watcher);
}

}  // namespace
}  // namespace meniscus::server::test
