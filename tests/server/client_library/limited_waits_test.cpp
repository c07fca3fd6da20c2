// Waits that end though nothing has come, which differs from the end of the stream.
#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <vector>

#include "recording/recording_service.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::milliseconds guard = 60s;

/// Looks until there is a frame or the end.
template <class Source>
auto look(Source& source) {
    for (;;) {
        auto next = source.try_next();
        if (next || next.ended) return next;
        std::this_thread::yield();
    }
}

TEST(LimitedWait, OfAStreamTellsNothingYetFromTheEnd) {
    RunningServer running;
    auto stream = running.client.stream(running.session());
    EXPECT_FALSE(stream.try_next());
    const auto nothing = stream.next(20ms);
    EXPECT_FALSE(nothing);
    EXPECT_FALSE(nothing.ended);
    stream.push(wave(4, 0.0).view(), 7, 0.0);
    const auto frame = stream.next(guard);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, 7U);
    stream.finish();
    EXPECT_TRUE(look(stream).ended);
    EXPECT_TRUE(stream.next(guard).ended);
}

TEST(LimitedWait, OfAWatcherTellsNothingYetFromTheEndAndLosesNoFrame) {
    RunningServer running;
    const std::string id = running.session();
    auto watcher = running.client.watch(id);
    auto particles = running.client.watch_particles(id);
    EXPECT_FALSE(watcher.try_next().ended);
    EXPECT_FALSE(watcher.next(20ms));
    EXPECT_FALSE(particles.next(20ms));
    auto stream = running.client.stream(id);
    for (std::uint64_t i = 0; i < 6; ++i) {
        const Particles pushed = wave(6, static_cast<double>(i));
        stream.push(pushed.view(), i, 0.0);
        ASSERT_TRUE(stream.next());
        // However the frame is waited for, it is the one that was pushed, and the changes are those since the last one.
        std::optional<client::ReceivedFrame> frame;
        if (i % 3 == 0) frame = look(watcher).frame;
        if (i % 3 == 1) frame = watcher.next();
        if (i % 3 == 2) frame = watcher.next(guard).frame;
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->index, i);
        EXPECT_FALSE(frame->changed.empty());
        EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(pushed));
        const auto same = i % 2 == 0 ? look(particles) : particles.next(guard);
        ASSERT_TRUE(same);
        EXPECT_EQ(same->index, i);
    }
    running.client.delete_session(id);
    EXPECT_TRUE(watcher.next(guard).ended);
    EXPECT_TRUE(particles.next(guard).ended);
    for (int look = 0; look < 20; ++look) {
        EXPECT_TRUE(watcher.try_next().ended) << "an end is not followed by a 'nothing yet'";
        EXPECT_TRUE(particles.try_next().ended);
    }
    EXPECT_FALSE(watcher.next());
}

TEST(LimitedWait, ThrowsWhatTheCallEndedWithOnce) {
    RunningServer running;
    auto watcher = running.client.watch(client::new_session_id());
    EXPECT_THROW(watcher.next(guard), client::ServerError);
    EXPECT_TRUE(watcher.next(guard).ended);
}

TEST(LimitedWait, EndsWithTheErrorOfAServerThatDiesMeanwhile) {
    auto running = std::make_unique<RunningServer>();
    const std::string id = running->session();
    client::Client client(running->server.address());
    auto watcher = client.watch(id);
    auto stream = client.stream(id);
    EXPECT_FALSE(watcher.try_next());
    EXPECT_FALSE(stream.try_next());
    auto dying = std::async(std::launch::async, [&] { running.reset(); });
    EXPECT_THROW(watcher.next(guard), client::ServerError);
    EXPECT_THROW(stream.next(guard), client::ServerError);
}

TEST(LimitedWait, MayBeOfAnyLength) {
    RunningServer running;
    const std::string id = running.session();
    auto stream = running.client.stream(id);
    auto watcher = running.client.watch(id);
    EXPECT_FALSE(stream.next(-1h));
    EXPECT_FALSE(watcher.next(std::chrono::milliseconds::min()));
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    EXPECT_TRUE(stream.next(std::chrono::milliseconds::max()));
    EXPECT_TRUE(watcher.next(std::chrono::milliseconds::max()));
}

class LimitedWaitOfRecording : public RecordingService {};

TEST_F(LimitedWaitOfRecording, ReadsEveryFrameInOrderAndThenTheEnd) {
    RunningServer running(options());
    const std::string id = recorded(running, {wave(4, 0.0), wave(4, 1.0), wave(4, 2.0), wave(4, 3.0)});
    auto reader = running.client.read_recording(id, 1);
    EXPECT_EQ(look(reader)->index, index_of(0));
    EXPECT_EQ(reader.next()->index, index_of(1));
    EXPECT_EQ(reader.next(guard)->index, index_of(2));
    EXPECT_EQ(look(reader)->index, index_of(3));
    EXPECT_TRUE(look(reader).ended);
    EXPECT_TRUE(reader.try_next().ended);
    EXPECT_FALSE(reader.next());
}

TEST_F(LimitedWaitOfRecording, EndsWhenItsCallerCancels) {
    RunningServer running(options());
    const std::string id = recorded(running, std::vector<Particles>(6, spray(12)));
    auto reader = running.client.read_recording(id, 1);
    EXPECT_TRUE(reader.next(guard));
    reader.cancel();
    EXPECT_TRUE(reader.next(guard).ended);
    EXPECT_FALSE(reader.next());
    std::stop_source stopping;
    auto stopped = running.client.read_recording(id, 1, {.stop = stopping.get_token()});
    EXPECT_TRUE(stopped.next());
    stopping.request_stop();
    EXPECT_FALSE(stopped.next());
    auto left = running.client.read_recording(id, 1);
    EXPECT_FALSE(left.try_next().ended);  // goes while it receives
}

}  // namespace
}  // namespace meniscus::server::test
