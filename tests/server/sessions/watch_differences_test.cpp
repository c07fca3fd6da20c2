// A watcher's mesh, merged from differences, is the session's, whatever it misses.
#include <gtest/gtest.h>

#include <cstdio>
#include <optional>
#include <random>
#include <vector>

#include "made_frames.hpp"
#include "receiving/frame_receiver.hpp"
#include "sessions/watching/watch.hpp"

namespace meniscus::server::test {
namespace {

std::uint32_t below(std::uint32_t limit, std::mt19937& random) {
    return static_cast<std::uint32_t>(random() % limit);
}

/// The next state of a changing mesh: bricks change, come and go.
void change(Versions& versions, std::mt19937& random) {
    const auto along = [&] { return static_cast<std::int32_t>(below(4, random)) - 1; };
    const auto place = [&] { return std::array<std::int32_t, 3>{along(), along(), along()}; };
    for (std::uint32_t n = below(6, random); n > 0; --n) versions[place()] = 1 + below(1000, random);
    for (std::uint32_t n = below(4, random); n > 0; --n) versions.erase(place());
    if (below(40, random) == 0) versions.clear();
}

/// The versions of the bricks that a watcher with this region should have.
Versions within(const Versions& versions, const std::optional<Box>& region) {
    Versions inside;
    for (const auto& [place, version] : versions) {
        bool touches = true;
        for (std::size_t axis = 0; region && axis < 3; ++axis)
            touches = touches && place[axis] <= region->max[axis] && place[axis] + 1 >= region->min[axis];
        if (touches) inside[place] = version;
    }
    return inside;
}

Versions received_versions(const client::ReceivedFrame& frame) {
    Versions versions;
    for (const auto& brick : frame.bricks) versions[brick->coordinate] = brick->triangles;
    return versions;
}

struct Figures {
    std::size_t states = 0;     ///< that the session's mesh was in
    std::size_t completed = 0;  ///< frames that came through

    Figures& operator+=(const Figures& other) {
        states += other.states;
        completed += other.completed;
        return *this;
    }
    void print() const {
        std::printf(
            "%zu states of a mesh, %zu frames merged from differences: each equal to its state, none begun older than "
            "the newest\n",
            states, completed);
    }
};

/// The session puts frames, the writer takes messages and sometimes stops for longer than a stalled one may.
Figures run(std::uint32_t seed, const std::optional<Box>& region) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    WatchOptions options;
    options.region = region;
    if (seed % 3 == 1) options.viewpoint = {0.0, 1.0, 2.0};
    if (seed % 3 == 2) options.bytes_per_second = 3000;
    Watch watch(options, [] {});
    auto now = Watch::Clock::now();
    client::FrameReceiver receiver(true, true);
    std::vector<Versions> states;
    Versions versions;
    std::uint64_t newest_at_begin = 0;
    std::size_t completed = 0;
    const auto take = [&] {
        const auto next = watch.take(now);
        const auto* message = std::get_if<SharedMessage>(&next);
        if (message == nullptr) return false;
        v1::WatchResponse response;
        EXPECT_TRUE(response.ParseFromString(**message));
        if (response.has_mesh_begin()) newest_at_begin = states.size() - 1;
        if (const auto frame = receiver.take(response)) {
            ++completed;
            // One in flight: nothing older is begun than what is newest at that moment.
            EXPECT_EQ(frame->index, newest_at_begin);
            EXPECT_EQ(received_versions(*frame), within(states.at(frame->index), region));
        }
        return true;
    };
    for (int step = 0; step < 2000; ++step) {
        now += std::chrono::milliseconds(below(10, random) != 0 ? 1U : below(3000, random));
        if (below(4, random) == 0) {
            change(versions, random);
            states.push_back(versions);
            watch.put(made_frame(states.size() - 1, versions), now);
        } else {
            for (std::uint32_t n = below(12, random); n > 0 && take(); --n) {
            }
        }
    }
    now += std::chrono::hours(1);
    while (take()) {
    }
    EXPECT_EQ(newest_at_begin, states.size() - 1);
    EXPECT_GT(completed, 10U);
    return {.states = states.size(), .completed = completed};
}

TEST(WatchDifferences, GiveTheWholeMeshUnderRandomStallsAndDrops) {
    Figures figures;
    for (std::uint32_t seed = 0; seed < 30; ++seed) figures += run(seed, std::nullopt);
    figures.print();
}

TEST(WatchDifferences, GiveTheMeshWithinARegionUnderRandomStallsAndDrops) {
    Figures figures;
    for (std::uint32_t seed = 100; seed < 115; ++seed) figures += run(seed, Box{{-0.5, 0.5, 1.0}, {1.5, 0.6, 2.5}});
    figures.print();
}

}  // namespace
}  // namespace meniscus::server::test
