// Streams that outlive their connection, and their server.
#include <gtest/gtest.h>

#include <numeric>
#include <optional>
#include <thread>
#include <vector>

#include "meniscus/error.hpp"
#include "observation/metrics.hpp"
#include "running_server.hpp"
#include "tcp_proxy.hpp"
#include "tcp_server.hpp"

namespace meniscus::server::test {
namespace {

constexpr std::chrono::milliseconds patient{60'000};

std::vector<std::uint64_t> numbers(std::uint64_t count) {
    std::vector<std::uint64_t> result(count);
    std::iota(result.begin(), result.end(), 0U);
    return result;
}

/// Pushes frames 0 to count - 1 in a thread; returns the indices of the frames received, each of which goes to
/// `on_frame`.
std::vector<std::uint64_t> exchange_frames(client::Stream& stream, std::uint64_t count,
                                           const std::function<void(std::uint64_t)>& on_frame) {
    std::thread pusher([&] {
        for (std::uint64_t i = 0; i < count; ++i) stream.push(wave(8, static_cast<double>(i)).view(), i, 0.0);
        stream.finish();
    });
    std::vector<std::uint64_t> received;
    while (const auto frame = stream.next()) {
        received.push_back(frame->index);
        EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(wave(8, static_cast<double>(frame->index))));
        on_frame(frame->index);
    }
    pusher.join();
    return received;
}

TEST(Client, FindsAServerThatIsFarAway) {
    RunningServer running(on_tcp());
    TcpProxy proxy(port_of(running.server.address()), std::chrono::milliseconds(400));
    client::Client far(proxy.address());
    EXPECT_TRUE(far.serving());
}

TEST(ReconnectingStream, LosesNothingAndRepeatsNothingWhenItsConnectionIsCut) {
    RunningServer running(on_tcp());
    TcpProxy proxy(port_of(running.server.address()));
    client::Client far(proxy.address());
    const std::string id = running.session();
    auto watcher = running.client.watch(id);
    constexpr std::uint64_t count = 40;
    std::vector<std::uint64_t> shown;
    std::thread watching([&] {
        while (shown.empty() || shown.back() + 1 < count) {
            const auto frame = watcher.next();
            if (!frame) return;
            shown.push_back(frame->index);
        }
    });
    auto stream = far.stream(id, {.reconnect = patient});
    const auto received = exchange_frames(stream, count, [&](std::uint64_t index) {
        if (index % 8 == 3) proxy.cut();
    });
    watching.join();
    EXPECT_EQ(received, numbers(count));
    for (std::size_t i = 1; i < shown.size(); ++i) EXPECT_LT(shown[i - 1], shown[i]);
    EXPECT_GE(running.client.session(id).frames, count);
}

TEST(ReconnectingStream, GoesOnWithTheServerThatTakesThePlaceOfOneThatIsShutDown) {
    auto running = std::make_unique<RunningServer>(on_tcp());
    const std::uint16_t port = port_of(running->server.address());
    const std::string id = running->session();
    client::Client client("127.0.0.1:" + std::to_string(port));
    auto stream =
        client.stream(id, {.waiting_limit = 4, .reconnect = patient});  // there is always something left to send
    const auto received = exchange_frames(stream, 30, [&](std::uint64_t index) {
        if (index != 4 && index != 20) return;
        running->server.shutdown();
        running.reset();
        running = std::make_unique<RunningServer>(on_tcp(port));
    });
    EXPECT_EQ(received, numbers(30));
    EXPECT_EQ(running->client.session(id).settings, in_force(settings()));
}

TEST(ReconnectingStream, WaitsForAServerThatIsFull) {
    auto running = std::make_unique<RunningServer>(on_tcp());
    const std::uint16_t port = port_of(running->server.address());
    const std::string id = running->session();
    TcpProxy proxy(port);
    client::Client client(proxy.address());
    auto stream = client.stream(id, {.reconnect = patient});
    proxy.refuse_for(std::chrono::hours(1));  // until the only place is taken
    running.reset();
    ServerOptions small = on_tcp(port);
    small.http = "127.0.0.1:0";
    small.limits.sessions = 1;
    running = std::make_unique<RunningServer>(small);
    const std::string other = running->session();
    proxy.refuse_for(std::chrono::hours(0));
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    while (calls_ended(scrape(running->server.http_address()), "ResourceExhausted") == 0) std::this_thread::yield();
    running->client.delete_session(other);
    EXPECT_EQ(stream.next()->index, 0U);
}

TEST(ReconnectingStream, SaysSinceWhenTheServerIsGoneOnceItsPatienceEnds) {
    auto running = std::make_unique<RunningServer>(on_tcp());
    client::Client client(running->server.address());
    auto stream = client.stream(running->session(), {.reconnect = std::chrono::seconds(1)});
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    ASSERT_TRUE(stream.next());
    running.reset();
    try {
        stream.next();
        FAIL();
    } catch (const client::ServerError& error) {
        EXPECT_NE(std::string(error.what()).find("has not been available for 1 s"), std::string::npos) << error.what();
    }
    EXPECT_THROW(stream.push(wave(4, 0.0).view(), 1, 0.0), client::ServerError);
}

TEST(ReconnectingStream, HasAllItsPatienceForEachBreakThoughItsSimulatorRests) {
    RunningServer running(on_tcp());
    TcpProxy proxy(port_of(running.server.address()));
    client::Client far(proxy.address());
    constexpr std::chrono::milliseconds patience{1000};
    auto stream = far.stream(running.session(), {.reconnect = patience});
    proxy.cut();
    std::this_thread::sleep_for(patience + std::chrono::milliseconds(200));
    proxy.cut();
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    EXPECT_EQ(stream.next()->index, 0U);
}

TEST(ReconnectingStream, CanBeLeftWhileTheServerIsGone) {
    auto running = std::make_unique<RunningServer>(on_tcp());
    client::Client client(running->server.address());
    auto stream = client.stream(running->session(), {.reconnect = patient});
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    ASSERT_TRUE(stream.next());
    running.reset();
}

TEST(ReconnectingStream, IsOpenedAgainWithTheNextFrameAfterItsServerEndedItForIdleness) {
    ServerOptions options = on_tcp();
    options.http = "127.0.0.1:0";
    options.limits.idle_time = std::chrono::milliseconds(300);
    RunningServer running(options);
    const std::string id = running.session();
    auto stream = running.client.stream(id, {.reconnect = patient});
    const auto wait_until_ended = [&](double times) {
        while (calls_ended(scrape(running.server.http_address()), "ResourceExhausted") < times)
            std::this_thread::yield();
    };
    for (std::uint64_t i = 0; i < 3; ++i) {
        wait_until_ended(static_cast<double>(i));
        stream.push(wave(4, 0.0).view(), i, 0.0);
        EXPECT_EQ(stream.next()->index, i);
    }
    wait_until_ended(3);
    stream.finish();
    EXPECT_FALSE(stream.next());
    auto impatient = running.client.stream(running.session());
    EXPECT_THROW(impatient.next(), LimitExceeded);
}

TEST(ReconnectingStream, DoesNotTryAgainWhatWasRefused) {
    RunningServer running;
    const std::string id = running.session();
    auto stream = running.client.stream(id, {.reconnect = patient});
    Particles bad = wave(3, 0.0);
    bad.positions[5] = std::numeric_limits<float>::infinity();
    stream.push(bad.view(), 0, 0.0);
    EXPECT_THROW(stream.next(), InvalidInput);
    auto deleted = running.client.stream(id, {.reconnect = patient});
    running.client.delete_session(id);
    EXPECT_THROW(deleted.next(), client::ServerError);
    EXPECT_TRUE(running.client.sessions().empty());
}

TEST(StreamPolicy, TellsTheCallerEveryFrameThatWasDropped) {
    RunningServer running;
    for (const client::UploadPolicy policy : {client::UploadPolicy::latest, client::UploadPolicy::every_nth}) {
        const std::string id = running.session();
        auto stream = running.client.stream(id, {.policy = policy, .nth = 3});
        constexpr std::uint64_t count = 31;
        const Particles particles = wave(10, 0.0);
        for (std::uint64_t i = 0; i < count; ++i) stream.push(particles.view(), i, 0.0);
        stream.finish();
        std::vector<std::uint64_t> told;
        std::uint64_t received = 0;
        while (const auto frame = stream.next()) {
            for (const client::DroppedFrame& dropped : frame->dropped) told.push_back(dropped.index);
            told.push_back(frame->index);
            ++received;
        }
        EXPECT_EQ(told, numbers(count));  // the last one is never dropped, by neither policy
        EXPECT_EQ(stream.dropped(), count - received);
        EXPECT_EQ(running.client.session(id).frames_dropped, count - received);
        EXPECT_TRUE(policy != client::UploadPolicy::every_nth || received == 11) << received;
    }
}

}  // namespace
}  // namespace meniscus::server::test
