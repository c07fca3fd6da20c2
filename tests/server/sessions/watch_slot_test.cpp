// The messages that a session hands to a watcher, one by one, in times that the tests make up.
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "made_frames.hpp"
#include "sessions/watching/watch.hpp"

namespace meniscus::server {
namespace {

using namespace std::chrono_literals;

v1::WatchResponse parsed(const SharedMessage& message) {
    v1::WatchResponse response;
    EXPECT_TRUE(response.ParseFromString(*message));
    return response;
}

struct WatchSlot : testing::Test {
    v1::WatchResponse take() { return parsed(std::get<SharedMessage>(watch.take(now))); }
    /// To the end of a frame; its index.
    std::uint64_t take_frame() {
        for (;;) {
            const v1::WatchResponse response = take();
            if (response.has_frame_statistics()) return response.frame_statistics().frame_index();
        }
    }
    bool has_nothing() { return std::holds_alternative<Watch::Nothing>(watch.take(now)); }

    int woken = 0;
    Watch watch{{}, [this] { ++woken; }};
    Watch::Clock::time_point now = Watch::Clock::now();
};

TEST_F(WatchSlot, IsReplacedByNewerState) {
    for (std::uint64_t i = 0; i < 5; ++i) watch.put(test::made_frame(i, {}), now);
    EXPECT_EQ(take_frame(), 4U);
    EXPECT_TRUE(has_nothing());
    EXPECT_EQ(watch.progress(now).frames_skipped, 4U);
}

TEST_F(WatchSlot, WakesAWaitingWriterOnce) {
    watch.put(test::made_frame(0, {}), now);
    EXPECT_EQ(woken, 0);
    take_frame();
    EXPECT_TRUE(has_nothing());
    watch.put(test::made_frame(1, {}), now);
    watch.put(test::made_frame(2, {}), now);
    EXPECT_EQ(woken, 1);
}

TEST_F(WatchSlot, GivesTheLastFrameBeforeTheEnd) {
    watch.put(test::made_frame(3, {}), now);
    watch.finish(std::make_exception_ptr(std::runtime_error("over")));
    watch.finish(nullptr);
    watch.put(test::made_frame(4, {}), now);
    EXPECT_EQ(take_frame(), 3U);
    EXPECT_NE(std::get<Watch::End>(watch.take(now)).error, nullptr);
}

TEST_F(WatchSlot, AnnouncesTheEndBetweenTwoMessagesOfAFrame) {
    watch.put(test::made_frame(0, {{{0, 0, 0}, 1}}), now);
    EXPECT_TRUE(take().has_mesh_begin());
    watch.announce_end(7.5s);
    EXPECT_EQ(take().draining().seconds(), 7.5);
    EXPECT_EQ(take_frame(), 0U);
    EXPECT_TRUE(has_nothing());
    watch.announce_end(1s);
    EXPECT_EQ(woken, 1);
    EXPECT_TRUE(take().has_draining());
}

TEST_F(WatchSlot, AnnouncesAFrameInWhichNothingHasChanged) {
    const test::Versions versions{{{0, 0, 0}, 1}, {{1, 0, 0}, 2}};
    watch.put(test::made_frame(0, versions), now);
    take_frame();
    watch.put(test::made_frame(1, versions), now);
    const v1::MeshBegin begin = take().mesh_begin();
    EXPECT_EQ(begin.base_frame_index(), 0U);
    EXPECT_EQ(begin.brick_count(), 0U);
    EXPECT_EQ(begin.vanished_size(), 0);
    EXPECT_EQ(begin.triangle_count(), 3U);
    EXPECT_EQ(take().frame_statistics().frame_index(), 1U);
}

TEST_F(WatchSlot, MeasuresHowLongTheWatcherHasNotHadTheNewestFrame) {
    EXPECT_EQ(watch.progress(now + 9s).lag, 0s);
    watch.put(test::made_frame(0, {}), now);
    watch.put(test::made_frame(1, {}), now + 1s);
    EXPECT_EQ(watch.progress(now + 3s).lag, 3s);
    take();  // the begin of frame 1
    watch.put(test::made_frame(2, {}), now + 2s);
    EXPECT_EQ(watch.progress(now + 3s).lag, 3s);
    take();  // the end of frame 1: what is owed since then is frame 2
    EXPECT_EQ(watch.progress(now + 3s).lag, 1s);
    take_frame();
    EXPECT_EQ(watch.progress(now + 3s).lag, 0s);
}

TEST(WatchMetrics, CountSkippedFramesAndTheTimeUntilTheEndOfAFrameHasBeenWritten) {
    struct Counted : Metrics {
        void frame_skipped() override { ++skipped; }
        void watcher_lag(double seconds) override { lags.push_back(seconds); }
        int skipped = 0;
        std::vector<double> lags;
    };
    const auto metrics = std::make_shared<Counted>();
    Watch watch(
        {}, [] {}, metrics);
    const auto now = Watch::Clock::now();
    watch.put(test::made_frame(0, {}), now);
    const auto frame = test::made_frame(1, {});
    frame->received_at = now;
    watch.put(frame, now);
    EXPECT_EQ(metrics->skipped, 1);
    watch.take(now);
    watch.take(now + 1s);
    EXPECT_TRUE(metrics->lags.empty());
    watch.take(now + 3s);
    EXPECT_EQ(metrics->lags, (std::vector<double>{3.0}));
}

TEST_F(WatchSlot, GivesUpTheRestOfAFrameForANewerOneOnceItsWatcherHasStoppedReading) {
    const test::Versions versions{{{0, 0, 0}, 1}, {{1, 0, 0}, 2}, {{2, 0, 0}, 3}};
    watch.put(test::made_frame(0, versions), now);
    take();
    take();
    watch.put(test::made_frame(1, versions), now + Watch::stalled_after);
    now += Watch::stalled_after + 1ms;
    watch.put(test::made_frame(2, versions), now);
    const v1::MeshBegin begin = take().mesh_begin();
    EXPECT_EQ(begin.frame_index(), 2U);
    EXPECT_FALSE(begin.has_base_frame_index());
    EXPECT_EQ(begin.brick_count(), 3U);
    EXPECT_EQ(watch.progress(now).frames_skipped, 2U);
}

TEST_F(WatchSlot, SendsAFrameToItsEndWhileItsWatcherReads) {
    const test::Versions versions{{{0, 0, 0}, 1}, {{1, 0, 0}, 2}};
    watch.put(test::made_frame(0, versions), now);
    take();
    now += Watch::stalled_after - 1ms;
    watch.put(test::made_frame(1, versions), now);
    take();
    now += Watch::stalled_after - 1ms;
    watch.put(test::made_frame(2, versions), now);
    EXPECT_EQ(take_frame(), 0U);
    EXPECT_EQ(take_frame(), 2U);
}

TEST_F(WatchSlot, KeepsNothingOfOldEncodesAliveForAWatcherThatHasStoppedReading) {
    constexpr std::size_t padding = 100000;
    std::vector<std::weak_ptr<const std::string>> old;
    std::shared_ptr<const EncodedFrame> newest;
    const auto put = [&](std::uint64_t index) {
        test::Versions versions;
        for (std::int32_t x = 0; x < 50; ++x) versions[{x, 0, 0}] = 3 * static_cast<std::uint32_t>(index) + 2;
        if (newest)
            for (const SharedBrick& brick : newest->bricks)
                old.insert(old.end(), brick->messages.begin(), brick->messages.end());
        newest = test::made_frame(index, versions, padding);
        watch.put(newest, now);
    };
    put(0);
    take();
    const SharedMessage being_written = std::get<SharedMessage>(watch.take(now));
    for (std::uint64_t index = 1; index < 5; ++index) {
        now += Watch::stalled_after;
        put(index);
    }
    std::size_t bytes = 0;
    for (const auto& message : old)
        if (const auto alive = message.lock()) bytes += alive->size();
    EXPECT_EQ(bytes, being_written->size());
}

TEST(WatchOrder, SendsTheBricksWithTheMostTrianglesFirst) {
    Watch watch({}, [] {});
    watch.put(test::made_frame(0, {{{0, 0, 0}, 3}, {{1, 0, 0}, 9}, {{2, 0, 0}, 6}}));
    std::vector<std::uint32_t> order;
    for (int i = 0; i < 4; ++i) {
        const auto response = parsed(std::get<SharedMessage>(watch.take()));
        if (response.has_mesh_brick()) order.push_back(response.mesh_brick().triangle_count());
    }
    EXPECT_EQ(order, (std::vector<std::uint32_t>{9, 6, 3}));
}

TEST(WatchOrder, SendsTheBricksNearestToTheViewpointFirst) {
    WatchOptions options;
    options.viewpoint = {2.6, 40.0, 0.5};
    Watch watch(options, [] {});
    watch.put(test::made_frame(0, {{{0, 0, 0}, 9}, {{4, 0, 0}, 3}, {{2, 0, 0}, 6}, {{2, 9, 0}, 12}}));
    std::vector<std::int32_t> order;
    for (int i = 0; i < 5; ++i) {
        const auto response = parsed(std::get<SharedMessage>(watch.take()));
        if (response.has_mesh_brick()) order.push_back(10 * response.mesh_brick().x() + response.mesh_brick().y());
    }
    EXPECT_EQ(order, (std::vector<std::int32_t>{29, 20, 40, 0}));
}

TEST(WatchRate, SpacesWholeFramesSoThatTheirMeanKeepsIt) {
    constexpr std::uint64_t rate = 100000;
    WatchOptions options;
    options.bytes_per_second = rate;
    Watch watch(options, [] {});
    const auto start = Watch::Clock::now() + 10s;
    auto now = start;
    std::uint64_t bytes = 0;
    std::uint64_t index = 0;
    std::uint64_t frames = 0;
    for (; now < start + 60s; now += 10ms) {
        ++index;
        watch.put(test::made_frame(index, {{{0, 0, 0}, static_cast<std::uint32_t>(3 * index)}}, 30000), now);
        bool torn = false;
        for (;;) {
            const auto next = watch.take(now);
            const auto* message = std::get_if<SharedMessage>(&next);
            if (message == nullptr) break;
            bytes += (*message)->size();
            torn = !parsed(*message).has_frame_statistics();
            frames += torn ? 0 : 1;
        }
        EXPECT_FALSE(torn);
        ASSERT_LE(bytes, rate * 61 + 30000 + 1000);
    }
    EXPECT_GT(bytes, rate * 58);
    EXPECT_LT(frames, index / 2);
}

TEST(WatchRate, SaysWhenTheNextFrameMayGoAndLetsTheLastOneGoAtOnce) {
    WatchOptions options;
    options.bytes_per_second = 1000;
    int woken = 0;
    Watch watch(options, [&] { ++woken; });
    const auto now = Watch::Clock::now() + 1s;
    watch.put(test::made_frame(0, {{{0, 0, 0}, 3}}, 20000), now);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::holds_alternative<SharedMessage>(watch.take(now)));
    watch.put(test::made_frame(1, {{{0, 0, 0}, 6}}, 20000), now);
    const auto at = std::get<Watch::Later>(watch.take(now)).at;
    EXPECT_GT(at, now + 18s);
    EXPECT_LT(at, now + 21s);
    watch.put(test::made_frame(2, {{{0, 0, 0}, 9}}, 20000), now);
    EXPECT_EQ(woken, 0);
    watch.finish(nullptr);
    EXPECT_EQ(woken, 1);
    EXPECT_EQ(parsed(std::get<SharedMessage>(watch.take(now))).mesh_begin().frame_index(), 2U);
}

TEST(WatchUpdate, SendsTheWholeMeshWhereTooManyBricksToNameHaveVanished) {
    Watch watch({}, [] {});
    const auto frame_of = [](std::uint64_t index, std::int32_t first, std::size_t count) {
        test::Versions versions;
        for (std::size_t i = 0; i < count; ++i) versions[{first + static_cast<std::int32_t>(i), 0, 0}] = 3;
        return test::made_frame(index, versions);
    };
    const auto begin_of = [&](const std::shared_ptr<EncodedFrame>& frame) {
        watch.put(frame);
        auto begin = parsed(std::get<SharedMessage>(watch.take())).mesh_begin();
        while (!parsed(std::get<SharedMessage>(watch.take())).has_frame_statistics()) {
        }
        return begin;
    };
    begin_of(frame_of(0, 0, max_vanished + 1));
    const auto just = begin_of(frame_of(1, static_cast<std::int32_t>(max_vanished), 1));
    EXPECT_EQ(just.base_frame_index(), 0U);
    EXPECT_EQ(just.vanished_size(), static_cast<int>(max_vanished));
    EXPECT_EQ(just.brick_count(), 0U);
    begin_of(frame_of(2, 0, max_vanished + 1));
    const auto whole = begin_of(frame_of(3, -1, 1));
    EXPECT_FALSE(whole.has_base_frame_index());
    EXPECT_EQ(whole.brick_count(), 1U);
}

}  // namespace
}  // namespace meniscus::server
