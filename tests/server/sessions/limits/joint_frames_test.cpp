// Bytes in flight of frames that several streams bring: every order of events of a small world.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "every_order.hpp"
#include "sessions/limits/bytes_in_flight.hpp"

namespace meniscus::server {
namespace {

using Clock = BytesInFlight::Clock;

constexpr std::size_t limit = 4;
constexpr std::size_t frame_count = 3;
constexpr std::size_t part_count = 2;

/// Two streams bring the bytes of a frame one by one; each waits while its last one is not booked.
struct JointFrame {
    JointFrame(const std::shared_ptr<BytesInFlight>& all, std::shared_ptr<SessionInFlight> session)
        : frame(all, std::move(session)) {}

    void begin(std::size_t bytes) {
        left = {bytes - bytes / 2, bytes / 2};
        frame.announce(bytes);
        for (std::size_t part = 0; part < part_count; ++part) book(part);
    }
    void arrive(std::size_t part) {
        --left[part];
        ++arrived;
        book(part);
    }
    void book(std::size_t part) {
        waits[part] = true;
        if (frame.book(arrived, [this, part] { waits[part] = false; })) waits[part] = false;
    }
    bool whole() const { return left == std::array<std::size_t, part_count>{} && !waits[0] && !waits[1]; }

    FrameInFlight frame;
    std::array<std::size_t, part_count> left{};
    std::array<bool, part_count> waits{};
    std::size_t arrived = 0;
};

class SmallWorldOfParts {
public:
    SmallWorldOfParts(std::array<std::size_t, frame_count> sizes, std::uint32_t sessions)
        : sizes_(sizes), sessions_(sessions) {}

    enum class Stage { idle, comes, gone };
    struct World {
        explicit World(std::uint32_t sessions)
            : bytes(std::make_shared<BytesInFlight>(limit, sessions, [this] { return now; })) {
            const auto session = std::make_shared<SessionInFlight>();
            for (std::size_t i = 0; i < frame_count; ++i)
                frames.emplace_back(bytes, sessions != 0 ? session : std::make_shared<SessionInFlight>());
        }
        Clock::time_point now{};
        std::shared_ptr<BytesInFlight> bytes;
        std::deque<JointFrame> frames;
        std::array<Stage, frame_count> stages{};
        std::array<int, frame_count> waited{};  ///< 1: for a second
        std::array<int, frame_count> sent{};    ///< likewise
        std::array<int, frame_count> late{};    ///< of those that have waited for a second, as its frame began
        bool broken = false;
    };

    /// Events: 't', a second passes; 'a' + 3 i + k, of frame i: it begins or ends (k = 0), its first or second part
    /// brings a byte.
    std::unique_ptr<World> after(const std::string& path) const {
        auto world = std::make_unique<World>(sessions_);
        for (const char event : path) {
            if (event == 't') {
                pass_a_second(*world);
            } else {
                const auto number = static_cast<std::size_t>(event - 'a');
                const std::size_t i = number / 3;
                if (number % 3 != 0) {
                    world->frames[i].arrive(number % 3 - 1);
                } else if (world->stages[i] == Stage::idle) {
                    world->stages[i] = Stage::comes;
                    for (std::size_t j = 0; j < frame_count; ++j) world->late[i] += world->waited[j] << j;
                    world->frames[i].begin(sizes_[i]);
                } else {
                    world->stages[i] = Stage::gone;
                    world->frames[i].frame.release();
                }
            }
            if (world->bytes->bytes() > limit) world->broken = true;
        }
        return world;
    }
    static void pass_a_second(World& world) {
        for (std::size_t i = 0; i < frame_count; ++i) {
            if (world.stages[i] != Stage::comes) continue;
            const auto& waits = world.frames[i].waits;
            (waits[0] || waits[1] ? world.waited : world.sent)[i] = 1;
        }
        world.now += std::chrono::seconds(1);
        world.bytes->look_again();
    }
    static bool all_are_gone(const World& world) {
        return std::ranges::all_of(world.stages, [](Stage stage) { return stage == Stage::gone; });
    }
    /// None: all that are left wait, and time alone does not help.
    static std::string events_in(const World& world, const std::string& path) {
        std::string events;
        for (std::size_t i = 0; i < frame_count; ++i) {
            const JointFrame& frame = world.frames[i];
            const auto first = static_cast<char>('a' + static_cast<char>(3 * i));
            if (world.stages[i] == Stage::idle || (world.stages[i] == Stage::comes && frame.whole())) events += first;
            if (world.stages[i] != Stage::comes) continue;
            for (std::size_t part = 0; part < part_count; ++part)
                if (frame.left[part] != 0 && !frame.waits[part])
                    events += static_cast<char>(first + 1 + static_cast<char>(part));
        }
        if (!path.ends_with("tt")) events += 't';
        return events;
    }
    static std::string key_of(const World& world, const std::string& path) {
        std::string key;
        for (std::size_t i = 0; i < frame_count; ++i) {
            const JointFrame& frame = world.frames[i];
            for (const int part :
                 {static_cast<int>(world.stages[i]), static_cast<int>(frame.left[0]), static_cast<int>(frame.left[1]),
                  frame.waits[0] ? 1 : 0, frame.waits[1] ? 1 : 0, world.waited[i], world.sent[i], world.late[i]})
                key += static_cast<char>('0' + part);
        }
        // The order of the announcements.
        for (const char event : path)
            if (event != 't' && (event - 'a') % 3 == 0 && key.find(event) == std::string::npos) key += event;
        const std::size_t last = path.find_last_not_of('t');
        return key + std::string(path.size() - (last == std::string::npos ? 0 : last + 1), 't');
    }

private:
    const std::array<std::size_t, frame_count> sizes_;
    const std::uint32_t sessions_;
};

TEST(JointFramesInASmallWorld, AllComeInWhicheverPartsWaitForBytesOfOthers) {
    std::size_t states = 0;
    for (const std::uint32_t sessions : {0U, 1U})  // no shares; one session, with a share of one byte
        for (std::size_t a = 2; a <= limit; ++a)
            for (std::size_t b = 1; b <= a; ++b) {
                const SmallWorldOfParts world({a, b, 1}, sessions);
                const test::Explored explored = test::explore(world);
                EXPECT_TRUE(explored.all_can_come) << a << b << "1 of 4 bytes, " << sessions << " shares";
                states += explored.states;
            }
    EXPECT_GT(states, 10'000U);
}

TEST(JointFrameInFlight, CallsAllPartsThatWaitOnceWhatHasArrivedByThenIsBooked) {
    const auto all = std::make_shared<BytesInFlight>(10);
    FrameInFlight before(all);
    before.announce(8);
    ASSERT_TRUE(before.book(8, [] {}));
    FrameInFlight joint(all);
    joint.announce(6);
    int called = 0;
    const auto call = [&] { ++called; };
    EXPECT_TRUE(joint.book(2, call));
    EXPECT_FALSE(joint.book(3, call));
    EXPECT_FALSE(joint.book(5, call));
    EXPECT_FALSE(joint.book(4, call)) << "of a part that was slower to say so";
    EXPECT_EQ(called, 0);
    before.release();
    EXPECT_EQ(called, 3);
    EXPECT_EQ(all->bytes(), 5U);
    EXPECT_EQ(all->waiting(), 0U);
}

}  // namespace
}  // namespace meniscus::server
