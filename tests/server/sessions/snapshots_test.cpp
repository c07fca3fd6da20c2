// Snapshots in a session: what they wait for, what they cost, and what they keep.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <semaphore>
#include <thread>
#include <vector>

#include "gated_session.hpp"
#include "made_frames.hpp"
#include "sessions/limits/limit_reached.hpp"
#include "sessions/limits/refusal.hpp"
#include "sessions/limits/snapshot_places.hpp"
#include "sessions/session/session_registry.hpp"
#include "sessions/watching/watchers.hpp"

namespace meniscus::server {
namespace {

WatchOptions snapshot(int normal_bits) {
    return {.format = {.position_bits = 6, .normal_bits = normal_bits}, .once = true};
}

std::shared_ptr<Watch> waiting(Watchers& watchers, int normal_bits) {
    auto watch = std::make_shared<Watch>(snapshot(normal_bits), [] {});
    EXPECT_FALSE(watchers.add(watch));
    return watch;
}

/// Messages until its end.
std::size_t count_messages(Watch& watch) {
    std::size_t count = 0;
    for (;; ++count) {
        const auto next = watch.take();
        if (std::holds_alternative<Watch::End>(next)) return count;
        EXPECT_TRUE(std::holds_alternative<SharedMessage>(next));
        if (!std::holds_alternative<SharedMessage>(next)) return count;
    }
}

TEST(Snapshots, EndAfterTheFrameThatIsPublishedFirst) {
    Watchers watchers;
    const auto watch = waiting(watchers, 8);
    EXPECT_EQ(watchers.unpublished_formats().size(), 1U);
    watchers.publish(watch->options().format, test::made_frame(0, {{{0, 0, 0}, 3}}));
    EXPECT_TRUE(watchers.unpublished_formats().empty());
    watchers.replace_meshes();
    EXPECT_TRUE(watchers.unpublished_formats().empty()) << "the next frame is not for it";
    watchers.publish(watch->options().format, test::made_frame(1, {{{0, 0, 0}, 9}}));
    EXPECT_EQ(count_messages(*watch), 3U);
}

TEST(Snapshots, AreNoWatchers) {
    Watchers watchers;
    const auto watch = waiting(watchers, 8);
    EXPECT_EQ(watchers.count(), 0U);
    EXPECT_EQ(watchers.progress().watchers, 0U);
}

TEST(Snapshots, OfOneFormatShareOneEncodeAndOnlyTheLastFormatIsKept) {
    Watchers watchers;
    const auto take = [&](int normal_bits, const std::shared_ptr<const EncodedFrame>& frame) {
        const auto watch = waiting(watchers, normal_bits);
        watchers.publish(watch->options().format, frame);
        EXPECT_GT(count_messages(*watch), 0U);
        watchers.remove(watch);
    };
    auto first = test::made_frame(0, {{{0, 0, 0}, 3}});
    take(8, first);
    const auto again = std::make_shared<Watch>(snapshot(8), [] {});
    EXPECT_TRUE(watchers.add(again)) << "it is there";
    EXPECT_GT(count_messages(*again), 0U);
    auto second = test::made_frame(0, {{{0, 0, 0}, 3}});
    take(9, second);
    EXPECT_EQ(first.use_count(), 1);
    EXPECT_EQ(second.use_count(), 2);
    watchers.replace_meshes();
    EXPECT_EQ(second.use_count(), 1);
}

TEST(Snapshots, TakeNothingFromTheWatchersOfTheirFormat) {
    Watchers watchers;
    const auto watcher = std::make_shared<Watch>(WatchOptions{.format = snapshot(8).format}, [] {});
    watchers.add(watcher);
    const auto watch = waiting(watchers, 8);
    auto frame = test::made_frame(0, {{{0, 0, 0}, 3}});
    watchers.publish(watch->options().format, frame);
    watchers.remove(watch);
    const auto other = waiting(watchers, 9);
    watchers.publish(other->options().format, test::made_frame(0, {{{0, 0, 0}, 3}}));
    EXPECT_TRUE(watchers.published(watcher->options().format)) << "it is watched still";
}

TEST(Snapshots, ThatWaitEndWithTheirSessionAndSayThatItWasDeleted) {
    test::GatedSession gated;
    test::Simulator simulator(gated.session, {});
    simulator.send(0, gated.particles);
    gated.gate.release();
    while (gated.session.state().frames == 0) std::this_thread::yield();
    // Without the function that emits them, no mesh of a coarser level comes.
    WatchOptions options = snapshot(8);
    options.format.max_level = 1;
    std::counting_semaphore<> awake{0};
    const auto watch = gated.session.open_watch(options, [&] { awake.release(); });
    EXPECT_TRUE(std::holds_alternative<Watch::Nothing>(watch->take()));
    gated.session.close();
    awake.acquire();
    const auto end = std::get<Watch::End>(watch->take());
    EXPECT_THROW(std::rethrow_exception(end.error), Refusal);
}

TEST(Snapshots, KeepNoSessionAlive) {
    using Clock = std::chrono::steady_clock;
    constexpr auto limit = std::chrono::hours(1);
    SessionRegistry registry{Limits{.idle_time = limit}, BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
    const auto session = registry.create(test::id, test::settings()).session;
    const auto created = Clock::now();
    while (Clock::now() - created < std::chrono::milliseconds(5)) std::this_thread::yield();
    registry.find(test::id, nullptr, SessionRegistry::Look::leaves_it_idle);
    const auto watch = session->open_watch(snapshot(8), [] {});
    session->close_watch(watch);
    registry.end_idle(created + limit);
    EXPECT_TRUE(registry.list().empty());
}

TEST(SnapshotPlaces, AreLimitedForAllAndForEachName) {
    SnapshotPlaces places(3, 2);
    const auto ada = std::make_shared<NameAccount>("ada");
    const auto ben = std::make_shared<NameAccount>("ben");
    std::vector<SnapshotPlaces::Place> taken{places.take(ada), places.take(ada)};
    EXPECT_THROW(places.take(ada), LimitReached);
    taken.push_back(places.take(ben));
    EXPECT_THROW(places.take(nullptr), LimitReached);
    taken.erase(taken.begin());
    EXPECT_NO_THROW(places.take(ada)) << "refusals have taken none";
}

TEST(SnapshotPlaces, MayBeGivenBackAfterTheEndOfAll) {
    SnapshotPlaces::Place place;
    {
        SnapshotPlaces places(1, 1);
        place = places.take(std::make_shared<NameAccount>("ada"));
    }
    place.reset();
}

}  // namespace
}  // namespace meniscus::server
