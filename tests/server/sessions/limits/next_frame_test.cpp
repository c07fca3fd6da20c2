// Large frames beside small ones that keep the bytes in flight busy, by a clock that the tests drive.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "every_order.hpp"
#include "sessions/limits/bytes_in_flight.hpp"
#include "sessions/limits/frame_sender.hpp"

namespace meniscus::server {
namespace {

using Clock = BytesInFlight::Clock;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::Sender;

/// The bytes in flight with a clock that stands still until it is moved.
struct DrivenBytes {
    DrivenBytes(std::size_t limit, std::uint32_t sessions)
        : all(std::make_shared<BytesInFlight>(limit, sessions, [this] { return now; })) {}

    /// As the server does it every second or so.
    void pass(Clock::duration time) {
        now += time;
        all->look_again();
    }

    Clock::time_point now{};
    const std::shared_ptr<BytesInFlight> all;
};

// A limit of 1000 bytes among 4 sessions: shares of 62 bytes, and 752 in common.
struct NextFrame : testing::Test, DrivenBytes {
    NextFrame() : DrivenBytes(1000, 4) {}

    Sender one{all};
    Sender another{all};
    Sender late{all};
};

TEST_F(NextFrame, IsTheOneThatHasWaitedForASecondAndNoOtherBeginsBeforeIt) {
    for (const std::size_t large : {800U, 900U, 1000U}) {
        one.begin(500);
        one.arrive(500);
        another.begin(large);
        another.arrive(large);
        ASSERT_TRUE(another.waits);
        pass(milliseconds(999));
        late.begin(100);
        EXPECT_FALSE(late.waits) << "it has not waited for long enough";
        late.frame.release();
        pass(milliseconds(1));
        late.begin(100);
        EXPECT_TRUE(late.waits);
        one.frame.release();
        EXPECT_TRUE(another.whole());
        EXPECT_EQ(late.waits, large == 1000U) << "there is room again beside it, unless it has all";
        another.frame.release();
        EXPECT_FALSE(late.waits);
        late.frame.release();
        EXPECT_EQ(all->bytes(), 0U);
    }
}

TEST_F(NextFrame, KeepsNoneWaitingForWhichThereIsRoomBesideIt) {
    one.begin(300);
    one.arrive(300);
    another.begin(780);
    another.arrive(780);
    ASSERT_TRUE(another.waits);
    pass(seconds(1));
    late.begin(62);
    late.arrive(62);
    EXPECT_TRUE(late.whole()) << "within its session's share";
    EXPECT_TRUE(another.waits);
    one.frame.release();
    EXPECT_TRUE(another.whole());
}

TEST_F(NextFrame, CannotStopThoseThatHaveBegun) {
    one.begin(600);
    one.arrive(100);
    another.begin(900);
    another.arrive(401);
    ASSERT_TRUE(another.waits);
    pass(seconds(1));
    one.arrive(500);
    EXPECT_TRUE(one.whole());
    EXPECT_TRUE(another.waits);
    one.frame.release();
    EXPECT_FALSE(another.waits);
}

TEST_F(NextFrame, IsNoneWhoseOwnBytesAreASecondOnTheirWay) {
    one.begin(500);
    one.arrive(500);
    another.begin(1000);
    another.arrive(1);
    another.arrive(500);
    ASSERT_TRUE(another.waits) << "one is here";
    pass(seconds(1));
    late.begin(300);
    one.frame.release();
    ASSERT_FALSE(another.waits);
    EXPECT_TRUE(late.waits);
    pass(milliseconds(999));
    EXPECT_TRUE(late.waits);
    pass(milliseconds(1));
    EXPECT_FALSE(late.waits);
    late.arrive(300);
    EXPECT_TRUE(late.whole());
}

TEST_F(NextFrame, IsNoneThatWaitsForASlowOne) {
    one.begin(1000);
    one.arrive(1);
    another.begin(1000);
    another.arrive(1);
    ASSERT_TRUE(another.waits);
    pass(seconds(1));
    for (const std::size_t bytes : {62U, 500U, 750U}) {
        late.begin(bytes);
        late.arrive(bytes);
        EXPECT_TRUE(late.whole()) << bytes;
        late.frame.release();
    }
    one.frame.release();
    EXPECT_FALSE(another.waits);
}

TEST_F(NextFrame, WaitsForSlowOnesThatHadBegunAndIsNextBesideThoseThatBeganLater) {
    Sender slow(all);
    one.begin(600);
    one.arrive(100);
    pass(seconds(1));
    another.begin(800);
    another.arrive(800);
    ASSERT_TRUE(another.waits);
    pass(seconds(1));
    slow.begin(250);
    slow.arrive(200);
    EXPECT_FALSE(slow.waits) << "the one that has waited waits for a slow one";
    pass(seconds(2));
    one.frame.release();
    late.begin(100);
    EXPECT_TRUE(late.waits);
    EXPECT_TRUE(another.waits);
    slow.arrive(50);
    slow.frame.release();
    EXPECT_TRUE(another.whole());
}

// As two callers can do it that send 5.9 MB each, at 120 kB/s, beside frames of 7.1 MB, where 8 MB may be in flight.
TEST(SlowFrames, ThatTakeTurnsDoNotKeepOutALargeOne) {
    constexpr std::size_t size = 5'900'000;
    constexpr std::size_t in_a_step = 12'000;
    constexpr milliseconds step{100};
    constexpr int upload = size / in_a_step + 1;
    DrivenBytes bytes(8'000'000, 16);
    std::deque<Sender> slow;
    std::deque<Sender> small;
    for (int i = 0; i < 2; ++i) slow.emplace_back(bytes.all);
    for (int i = 0; i < 6; ++i) small.emplace_back(bytes.all);
    Sender large(bytes.all);
    const auto send = [](Sender& stream, std::size_t all, std::size_t part) {
        if (stream.waits) return;
        if (stream.announced == 0 || stream.whole())
            stream.begin(all);
        else
            stream.arrive(part);
    };
    int at = 0;
    for (; large.announced == 0 || !large.whole(); ++at) {
        ASSERT_LE(at, 200 + 3 * upload) << "those that had begun, and one that began since";
        for (int i = 0; i < 2; ++i)
            if (at >= 70 * i) send(slow[static_cast<std::size_t>(i)], size, in_a_step);
        for (Sender& stream : small) send(stream, 720'000, 240'000);
        if (at >= 200) send(large, 7'100'000, 2'400'000);
        if (at % 10 == 0) bytes.all->look_again();
        bytes.now += step;
    }
    RecordProperty("waited_tenths_of_a_second", at - 200);
}

TEST_F(NextFrame, IsNoneThatWaitsForItsNamesShare) {
    const auto name = std::make_shared<NameInFlight>();
    name->limit = 800;
    const auto of_the_name = [&] { return std::make_shared<SessionInFlight>(SessionInFlight{.name = name}); };
    Sender first(all, of_the_name());
    Sender second(all, of_the_name());
    first.begin(200);
    first.arrive(200);
    second.begin(700);
    ASSERT_TRUE(second.waits);
    pass(seconds(10));
    late.begin(600);
    late.arrive(600);
    EXPECT_TRUE(late.whole());
}

TEST_F(NextFrame, IsTheOldestOfThoseThatHaveWaited) {
    Sender second(all);
    one.begin(600);
    one.arrive(600);
    another.begin(900);
    another.arrive(900);
    pass(milliseconds(500));
    second.begin(900);
    second.arrive(900);
    pass(seconds(2));
    one.frame.release();
    EXPECT_TRUE(another.whole());
    EXPECT_TRUE(second.waits);
    another.frame.release();
    EXPECT_TRUE(second.whole());
}

/// A device that reconstructs one frame after the other, and sessions that send theirs as fast as they may: into two
/// slots each, piece by piece over links of their own.
class Service {
public:
    static constexpr std::size_t piece = 240'000;
    static constexpr milliseconds a_piece_takes{2};
    static constexpr std::size_t bytes_a_millisecond = 3600;  ///< of the device: 0.2 s for 720 kB

    struct Session {
        std::shared_ptr<SessionInFlight> shared = std::make_shared<SessionInFlight>();
        std::size_t bytes = 0;  ///< of each frame
        std::size_t most = 0;   ///< frames to send; counted up to let it go on
        std::size_t begun = 0;
        std::size_t done = 0;
        std::optional<std::size_t> sends;  ///< slot
        Clock::duration longest_wait{};    ///< from the announcement to the last byte
        Clock::time_point began{};
        std::deque<Sender> slots;
        std::array<bool, 2> used{};
    };

    Session& add(std::size_t bytes, std::size_t most) {
        Session& session = sessions_.emplace_back();
        session.bytes = bytes;
        session.most = most;
        for (std::size_t i = 0; i < 2; ++i) session.slots.emplace_back(bytes_.all, session.shared);
        return session;
    }
    void run(
        Clock::duration time, const std::function<void()>& look = [] {}) {
        for (const auto end = bytes_.now + time; bytes_.now < end; bytes_.now += milliseconds(1)) {
            if (bytes_.now.time_since_epoch() % seconds(1) == seconds(0)) bytes_.all->look_again();
            for (Session& session : sessions_) send(session);
            work();
            look();
            ASSERT_LE(bytes_.all->bytes(), bytes_.all->limit());
        }
    }

private:
    void send(Session& session) {
        if (!session.sends) {
            const auto free = std::ranges::find(session.used, false);
            if (free == session.used.end() || session.begun == session.most) return;
            *free = true;
            ++session.begun;
            session.sends = static_cast<std::size_t>(free - session.used.begin());
            session.began = bytes_.now;
            session.slots[*session.sends].begin(session.bytes);
        }
        Sender& stream = session.slots[*session.sends];
        if (stream.whole()) {
            session.longest_wait = std::max(session.longest_wait, bytes_.now - session.began);
            arrived_.push_back({&session, *session.sends});
            session.sends.reset();
        } else if (!stream.waits && bytes_.now.time_since_epoch() % a_piece_takes == milliseconds(0)) {
            stream.arrive(piece);
        }
    }
    void work() {
        if (arrived_.empty()) return;
        const auto [session, slot] = arrived_.front();
        done_ += bytes_a_millisecond;
        if (done_ < session->bytes) return;
        done_ = 0;
        arrived_.pop_front();
        session->used[slot] = false;
        ++session->done;
        session->slots[slot].frame.release();
    }

    DrivenBytes bytes_{8'000'000, 16};
    std::deque<Session> sessions_;
    std::deque<std::pair<Session*, std::size_t>> arrived_;
    std::size_t done_ = 0;  ///< bytes of the frame on the device
};

TEST(LargeFrames, AreNotKeptOutBySmallOnesAndCostThemLittle) {
    constexpr std::size_t small = 720'000;
    constexpr std::size_t streams = 6;
    constexpr seconds time{240};
    constexpr milliseconds round{200 * streams};
    const auto frames = [&](bool with_large, Clock::duration& wait, std::size_t& large_done) {
        Service service;
        std::vector<Service::Session*> all;
        for (std::size_t i = 0; i < streams; ++i) all.push_back(&service.add(small, ~std::size_t{0}));
        Service::Session& large = service.add(10 * small, 0);
        const auto sum = [&] {
            std::size_t done = 0;
            for (const auto* session : all) done += session->done;
            return done;
        };
        service.run(time, [&] {
            if (with_large) large.most = sum() / (10 * streams);
        });
        wait = large.longest_wait;
        large_done = large.done;
        return sum();
    };
    Clock::duration wait{};
    std::size_t large = 0;
    const double without = static_cast<double>(frames(false, wait, large));
    const double with = static_cast<double>(frames(true, wait, large));
    EXPECT_GE(with / without, 0.8);
    EXPECT_GE(large, 15U);
    EXPECT_LE(wait, 3 * round) << std::chrono::duration<double>(wait).count() << " s";
    RecordProperty("large_frames", static_cast<int>(large));
    RecordProperty("longest_wait_ms", static_cast<int>(wait / milliseconds(1)));
    RecordProperty("throughput_percent", static_cast<int>(100 * with / without));
}

/// Every order of events of a small world: three frames of up to all four bytes, that begin, arrive byte by
/// byte and are released, and seconds that pass.
class SmallWorld {
public:
    SmallWorld(std::array<std::size_t, 3> sizes, std::uint32_t sessions) : sizes_(sizes), sessions_(sessions) {}

    enum class Stage { idle, comes, gone };
    struct World {
        World(std::uint32_t sessions, std::size_t limit) : bytes(limit, sessions) {
            const auto session = std::make_shared<SessionInFlight>();
            for (int i = 0; i < 3; ++i)
                streams.emplace_back(bytes.all, sessions != 0 ? session : std::make_shared<SessionInFlight>());
        }
        DrivenBytes bytes;
        std::deque<Sender> streams;
        std::array<Stage, 3> stages{};
        std::array<int, 3> waited{};  ///< 1: for a second
        std::array<int, 3> sent{};    ///< likewise
        std::array<int, 3> late{};    ///< of those that have waited for a second, as its frame began
        bool broken = false;
    };

    std::unique_ptr<World> after(const std::string& path) const {
        auto world = std::make_unique<World>(sessions_, 4);
        for (const char event : path) {
            if (event == 't') {
                for (std::size_t i = 0; i < 3; ++i) {
                    if (world->stages[i] != Stage::comes) continue;
                    int& time = (world->streams[i].waits ? world->waited : world->sent)[i];
                    time = 1;
                }
                world->bytes.pass(seconds(1));
            } else {
                const auto i = static_cast<std::size_t>(event - '0');
                Sender& stream = world->streams[i];
                if (world->stages[i] == Stage::idle) {
                    world->stages[i] = Stage::comes;
                    for (std::size_t j = 0; j < 3; ++j) world->late[i] += world->waited[j] << j;
                    stream.begin(sizes_[i]);
                } else if (!stream.whole()) {
                    stream.arrive(1);
                } else {
                    world->stages[i] = Stage::gone;
                    stream.frame.release();
                }
            }
            if (world->bytes.all->bytes() > 4) world->broken = true;
        }
        return world;
    }
    static bool all_are_gone(const World& world) {
        return std::ranges::all_of(world.stages, [](Stage stage) { return stage == Stage::gone; });
    }
    /// None: all that are left wait, and time alone does not help.
    static std::string events_in(const World& world, const std::string& path) {
        std::string events;
        for (std::size_t i = 0; i < 3; ++i)
            if (world.stages[i] != Stage::gone && !world.streams[i].waits)
                events += static_cast<char>('0' + static_cast<char>(i));
        if (!path.ends_with("tt")) events += 't';
        return events;
    }
    static std::string key_of(const World& world, const std::string& path) {
        std::string key;
        for (std::size_t i = 0; i < 3; ++i) {
            const Sender& stream = world.streams[i];
            for (const int part : {static_cast<int>(world.stages[i]), static_cast<int>(stream.arrived),
                                   stream.waits ? 1 : 0, world.waited[i], world.sent[i], world.late[i]})
                key += static_cast<char>('0' + part);
        }
        // The order of the announcements.
        for (const char event : path)
            if (event != 't' && key.find(event, 18) == std::string::npos) key += event;
        const std::size_t last = path.find_last_not_of('t');
        return key + std::string(path.size() - (last == std::string::npos ? 0 : last + 1), 't');
    }

private:
    const std::array<std::size_t, 3> sizes_;
    const std::uint32_t sessions_;
};

TEST(FramesInASmallWorld, AllComeInWhateverHappensInWhateverOrder) {
    std::size_t states = 0;
    for (const std::uint32_t sessions : {0U, 1U})  // no shares; one session, with a share of one byte
        for (std::size_t a = 1; a <= 4; ++a)
            for (std::size_t b = 1; b <= a; ++b)
                for (std::size_t c = 1; c <= b; ++c) {
                    const SmallWorld world({a, b, c}, sessions);
                    const test::Explored explored = test::explore(world);
                    EXPECT_TRUE(explored.all_can_come) << a << b << c << " of 4 bytes, " << sessions << " shares";
                    states += explored.states;
                }
    EXPECT_GT(states, 10'000U);
}

}  // namespace
}  // namespace meniscus::server
