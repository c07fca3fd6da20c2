// Frames in parts beside simulations, whose ranks are threads here: each is published whole, or by none.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>

#include "meniscus/live_parts.hpp"
#include "support/parts.hpp"
#include "support/refusal.hpp"
#include "support/thread_exchange.hpp"

namespace meniscus {
namespace {

/// What all ranks have published.
class Shown {
public:
    struct Frame {
        double simulation_time = 0.0;
        std::size_t publishers = 0;
        std::vector<Mesh> meshes;
        Statistics sum;
    };
    void add(const LivePart& part) {
        const std::lock_guard lock(mutex_);
        Frame& frame = frames_[part.index];
        ++frame.publishers;
        frame.simulation_time = part.simulation_time;
        if (part.mesh == nullptr) return;
        frame.meshes.push_back(*part.mesh);
        frame.sum.particles += part.statistics.particles;
        frame.sum.vertices += part.statistics.vertices;
        frame.sum.triangles += part.statistics.triangles;
        frame.sum.volume += part.statistics.volume;
    }
    const std::map<std::uint64_t, Frame>& frames() const { return frames_; }
    std::set<std::uint64_t> indices() const {
        std::set<std::uint64_t> indices;
        for (const auto& [index, frame] : frames_) indices.insert(index);
        return indices;
    }

private:
    std::mutex mutex_;
    std::map<std::uint64_t, Frame> frames_;
};

/// Adds what it is given to what is shown.
class Publisher : public LivePublisher {
public:
    explicit Publisher(Shown& shown) : shown_(shown) {}
    void publish(const LivePart& part) override { shown_.add(part); }
    void abandon() noexcept override { ++abandoned; }

    std::atomic<int> abandoned = 0;

private:
    Shown& shown_;
};

test::Particles frame_of(std::uint64_t index) {
    return test::splash(static_cast<unsigned>(70 + index), 8);
}

/// Dealt at random, and otherwise in each frame.
test::Particles share_of(const test::Particles& all, std::uint64_t index, std::size_t rank, std::size_t ranks) {
    std::mt19937 random(static_cast<unsigned>(index));
    test::Particles mine;
    for (std::size_t i = 0; i < all.count(); ++i)
        if (random() % ranks == rank)
            mine.add(all.positions[3 * i], all.positions[3 * i + 1], all.positions[3 * i + 2]);
    return mine;
}

Settings settings_of_parts() {
    Settings settings = test::default_settings();
    settings.cell_size = 0.25;
    return settings;
}

LiveParts live(const PartsOptions& options, LivePolicy policy, PartExchange& exchange, LivePublisher& publisher) {
    return {settings_of_parts(), {Backend::cpu, 1, 0}, options, policy, exchange, publisher};
}

void expect_whole(const Settings& settings, const test::Particles& particles, const Shown::Frame& frame) {
    Reconstructor reconstructor(settings, {Backend::cpu, 1, 0});
    Mesh whole;
    reconstructor.reconstruct(particles.frame(), whole);
    EXPECT_EQ(mesh_sha256(put_together(frame.meshes)), mesh_sha256(whole));
    EXPECT_EQ(frame.sum.particles, particles.count());
    EXPECT_EQ(frame.sum.vertices, whole.vertices.size());
    EXPECT_EQ(frame.sum.triangles, whole.triangles.size());
    EXPECT_EQ(frame.sum.volume, reconstructor.statistics().volume);
}

TEST(LiveParts, PublishTheWholesMeshOfEachFrameWhoeverMakesIt) {
    const std::vector<std::pair<std::size_t, std::vector<std::size_t>>> deals{
        {1, {0}}, {2, {0, 1}}, {3, {0}}, {4, {1, 3}}, {3, {0, 1, 2}}};
    for (const auto& [ranks, makers] : deals) {
        SCOPED_TRACE(testing::Message() << ranks << " ranks, " << makers.size() << " makers");
        Shown shown;
        test::on_ranks(ranks, [&, &among = ranks, &makes = makers](test::ThreadExchange& exchange) {
            Publisher publisher(shown);
            LiveParts parts =
                live({.parts = makes.size(), .makers = makes}, LivePolicy::every_frame, exchange, publisher);
            for (std::uint64_t i = 0; i < 3; ++i)
                EXPECT_TRUE(parts.push(share_of(frame_of(i), i, exchange.rank(), among).frame(), 10 * i,
                                       0.5 * static_cast<double>(i)));
            parts.finish();
            EXPECT_EQ(parts.dropped(), 0U);
        });
        ASSERT_EQ(shown.indices(), (std::set<std::uint64_t>{0, 10, 20}));
        for (const auto& [index, frame] : shown.frames()) {
            EXPECT_EQ(frame.publishers, makers.size());
            EXPECT_EQ(frame.simulation_time, 0.05 * static_cast<double>(index));
            expect_whole(settings_of_parts(), frame_of(index / 10), frame);
        }
    }
}

/// A block of water, and drops beside it: much surface of few particles.
test::Particles block_and_drops() {
    test::Particles particles;
    const auto add = [&particles](int x, int y, int z, float spacing, float from) {
        particles.add(from + static_cast<float>(x) * spacing, static_cast<float>(y) * spacing,
                      static_cast<float>(z) * spacing);
    };
    for (int i = 0; i < 16 * 16 * 16; ++i) add(i % 16, i / 16 % 16, i / 256, 0.05F, 0.0F);
    for (int i = 0; i < 16 * 4 * 4; ++i) add(i % 16, i / 16 % 4, i / 64, 0.2F, 1.2F);
    return particles;
}

TEST(LiveParts, AreDealtByTheSurfaceOfTheFrameBefore) {
    const test::Particles particles = block_and_drops();
    Shown shown;
    test::on_ranks(2, [&](test::ThreadExchange& exchange) {
        Publisher publisher(shown);
        LiveParts parts(test::default_settings(), {Backend::cpu, 1, 0}, {.parts = 2}, LivePolicy::every_frame, exchange,
                        publisher);
        // One rank owns all of them: the other one makes the drops.
        const test::Particles mine = exchange.rank() == 1 ? particles : test::Particles();
        for (std::uint64_t i = 0; i < 2; ++i) EXPECT_TRUE(parts.push(mine.frame(), i, 0.0));
        parts.finish();
    });
    const auto most = [&shown](std::uint64_t index) {
        std::size_t triangles = 0;
        for (const Mesh& mesh : shown.frames().at(index).meshes) triangles = std::max(triangles, mesh.triangles.size());
        return triangles;
    };
    EXPECT_LT(static_cast<double>(most(1)), 0.9 * static_cast<double>(most(0)));
    expect_whole(test::default_settings(), particles, shown.frames().at(1));
}

// A part that could not be made is no sign of little work.
TEST(LiveParts, AreDealtAsBeforeOnceARankHasFailed) {
    const test::Particles particles = block_and_drops();
    test::Particles spike = particles;
    for (int i = 0; i < 100000; ++i) {
        const int z = i / 2500;
        spike.add(static_cast<float>(i % 50) * 0.015F, static_cast<float>(i / 50 % 50) * 0.015F,
                  static_cast<float>(z) * 0.015F);
    }
    Shown shown;
    test::on_ranks(2, [&](test::ThreadExchange& exchange) {
        Publisher publisher(shown);
        LiveParts parts(test::default_settings(), {Backend::cpu, 1, std::size_t{16} << 20U}, {.parts = 2},
                        LivePolicy::every_frame, exchange, publisher);
        const auto push = [&](const test::Particles& all, std::uint64_t index) {
            return parts.push(share_of(all, 0, exchange.rank(), 2).frame(), index, 0.0);
        };
        for (std::uint64_t i = 0; i < 3; ++i) EXPECT_TRUE(push(particles, i));
        EXPECT_TRUE(push(spike, 3));
        EXPECT_NE(test::refusal<LimitExceeded>([&] { push(particles, 4); }), "");
        EXPECT_TRUE(push(particles, 5));
        parts.finish();
    });
    ASSERT_EQ(shown.indices(), (std::set<std::uint64_t>{0, 1, 2, 5}));
    const auto triangles = [&shown](std::uint64_t index) {
        std::multiset<std::size_t> triangles_of_parts;
        for (const Mesh& mesh : shown.frames().at(index).meshes) triangles_of_parts.insert(mesh.triangles.size());
        return triangles_of_parts;
    };
    EXPECT_EQ(triangles(5), triangles(2));
}

TEST(LiveParts, PublishNoPartBeforeSeamsAreEqual) {
    const test::Particles noise = test::noise_cube(62, 6000, 0.5, 0.025);
    Shown shown;
    std::atomic<std::uint64_t> unequal = 0;
    test::on_ranks(4, [&](test::ThreadExchange& exchange) {
        class Counting : public Publisher {
        public:
            Counting(Shown& shown, std::atomic<std::uint64_t>& unequal) : Publisher(shown), unequal_(unequal) {}
            void publish(const LivePart& part) override {
                unequal_ = part.report.unequal_seams;
                Publisher::publish(part);
            }

        private:
            std::atomic<std::uint64_t>& unequal_;
        } publisher(shown, unequal);
        LiveParts parts(test::default_settings(), {Backend::cpu, 1, 0}, {.parts = 4, .overlap = 1},
                        LivePolicy::every_frame, exchange, publisher);
        EXPECT_TRUE(parts.push(share_of(noise, 0, exchange.rank(), 4).frame(), 0, 0.0));
        parts.finish();
    });
    EXPECT_GT(unequal, 0U);
    ASSERT_EQ(shown.frames().size(), 1U);
    expect_whole(test::default_settings(), noise, shown.frames().at(0));
}

/// Holds the first frame until it is let go.
class Held : public Publisher {
public:
    using Publisher::Publisher;
    void publish(const LivePart& part) override {
        std::unique_lock lock(mutex_);
        is_holding_ = true;
        changed_.notify_all();
        changed_.wait(lock, [this] { return is_let_go_; });
        Publisher::publish(part);
    }
    void await() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return is_holding_; });
    }
    void let_go() {
        const std::lock_guard lock(mutex_);
        is_let_go_ = true;
        changed_.notify_all();
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool is_holding_ = false, is_let_go_ = false;
};

TEST(LiveParts, LeaveOutFramesOfAllWhileOneIsAtWork) {
    Shown shown;
    Held held(shown);
    test::on_ranks(3, [&](test::ThreadExchange& exchange) {
        Publisher free(shown);
        const bool is_held = exchange.rank() == 1;
        LivePublisher& publisher = is_held ? static_cast<LivePublisher&>(held) : free;
        LiveParts parts = live({.parts = 3}, LivePolicy::latest, exchange, publisher);
        std::uint64_t index = 0;
        const auto push = [&] {
            const std::uint64_t i = index++;
            return parts.push(share_of(frame_of(i), i, exchange.rank(), 3).frame(), i, 0.0);
        };
        EXPECT_TRUE(push());
        // The first frame is published once two more are taken, however long the first takes.
        for (int i = 0; i < 2; ++i)
            while (!push()) {
            }
        if (is_held) held.await();
        const std::uint64_t dropped = parts.dropped();
        for (int i = 0; i < 5; ++i) EXPECT_FALSE(push());
        EXPECT_EQ(parts.dropped(), dropped + 5);
        if (is_held) held.let_go();
        while (!push()) {
        }
        parts.finish();
        EXPECT_EQ(parts.dropped() + 4, index);
    });
    EXPECT_EQ(shown.frames().size(), 4U);
    for (const auto& [index, frame] : shown.frames()) {
        EXPECT_EQ(frame.publishers, 3U);
        expect_whole(settings_of_parts(), frame_of(index), frame);
    }
}

// One is prepared while that before it is made, made again or fails.
TEST(LiveParts, PublishEachFrameThatIsTakenWhateverBecomesOfOthers) {
    constexpr std::size_t ranks = 3;
    enum class Kind { splash, noise, refused, crowded };
    std::map<std::uint64_t, test::Particles> taken;
    std::uint64_t refusals = 0, failures = 0;
    test::Particles crowd;
    for (int i = 0; i < 60'000; ++i) crowd.add(1e-7F * static_cast<float>(i), 0.0F, 0.0F);
    std::vector<test::Particles> frames;
    std::vector<Kind> kinds;
    std::mt19937 random(12);
    for (unsigned i = 0; i < 24; ++i) {
        const Kind kind = i < 4 ? static_cast<Kind>(i) : static_cast<Kind>(random() % 4);
        kinds.push_back(kind);
        frames.push_back(kind == Kind::noise     ? test::noise_cube(i, 1500, 0.4, 0.025)
                         : kind == Kind::crowded ? crowd
                                                 : test::splash(i, 8));
        if (kind == Kind::refused) frames.back().positions[7] = INFINITY;
    }
    Shown shown;
    test::on_ranks(ranks, [&](test::ThreadExchange& exchange) {
        Publisher publisher(shown);
        LiveParts parts(test::default_settings(), {Backend::cpu, 1, 0}, {.parts = 2, .overlap = 1, .makers = {0, 2}},
                        LivePolicy::latest, exchange, publisher);
        std::uint64_t index = 0;
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const test::Particles mine = share_of(frames[i], i, exchange.rank(), ranks);
            try {
                while (!parts.push(mine.frame(), index, 0.0)) ++index;
                if (exchange.rank() == 0 && kinds[i] != Kind::crowded) taken[index] = frames[i];
            } catch (const InvalidInput&) {
                EXPECT_EQ(kinds[i], Kind::refused);
                if (exchange.rank() == 0) ++refusals;
            } catch (const LimitExceeded&) {
                if (exchange.rank() == 0) ++failures;
            }
            ++index;
        }
        try {
            parts.finish();
        } catch (const LimitExceeded&) {
            if (exchange.rank() == 0) ++failures;
        }
    });
    EXPECT_GT(refusals, 0U);
    EXPECT_GT(failures, 0U);
    EXPECT_GT(taken.size(), 5U);
    std::set<std::uint64_t> expected;
    for (const auto& [index, particles] : taken) expected.insert(index);
    ASSERT_EQ(shown.indices(), expected);
    for (const auto& [index, frame] : shown.frames()) {
        EXPECT_EQ(frame.publishers, 2U);
        expect_whole(test::default_settings(), taken.at(index), frame);
    }
}

TEST(LiveParts, TellTheFailureOfAPublisherToAllAndGoOn) {
    class Failing : public Publisher {
    public:
        using Publisher::Publisher;
        void publish(const LivePart& part) override {
            if (part.index == 1) throw std::runtime_error("the server is away");
            Publisher::publish(part);
        }
    };
    Shown shown;
    test::on_ranks(3, [&](test::ThreadExchange& exchange) {
        Publisher good(shown);
        Failing bad(shown);
        Publisher& publisher = exchange.rank() == 2 ? bad : good;
        LiveParts parts = live({.parts = 2, .makers = {0, 2}}, LivePolicy::every_frame, exchange, publisher);
        const auto push = [&](std::uint64_t i) {
            return parts.push(share_of(frame_of(i), i, exchange.rank(), 3).frame(), i, 0.0);
        };
        for (std::uint64_t i = 0; i < 3; ++i) EXPECT_TRUE(push(i));
        EXPECT_EQ(test::refusal<PublishingFailed>([&] { push(3); }), "rank 2: the server is away");
        EXPECT_TRUE(push(4));
        parts.finish();
        EXPECT_EQ(publisher.abandoned, exchange.rank() == 1 ? 0 : 1);
    });
    EXPECT_EQ(shown.indices(), (std::set<std::uint64_t>{0, 1, 2, 4}));
    EXPECT_EQ(shown.frames().at(1).publishers, 1U);
    for (const std::uint64_t index : {0U, 2U, 4U}) {
        EXPECT_EQ(shown.frames().at(index).publishers, 2U);
        expect_whole(settings_of_parts(), frame_of(index), shown.frames().at(index));
    }
}

TEST(LiveParts, MakeNoFramesWhileAPublisherIsAway) {
    class Away : public Publisher {
    public:
        using Publisher::Publisher;
        bool is_away() const noexcept override { return true; }
    };
    Shown shown;
    test::on_ranks(2, [&](test::ThreadExchange& exchange) {
        Publisher good(shown);
        Away bad(shown);
        LiveParts parts = live({.parts = 2}, LivePolicy::every_frame, exchange,
                               exchange.rank() == 1 ? static_cast<LivePublisher&>(bad) : good);
        EXPECT_FALSE(parts.push(frame_of(0).frame(), 0, 0.0));
        parts.finish();
    });
    EXPECT_TRUE(shown.frames().empty());
}

TEST(LiveParts, RefuseOnAllRanksWhatOneMustNotPushAndPublishTheFrameBefore) {
    Shown shown;
    test::Particles bad = frame_of(1);
    bad.positions[4] = INFINITY;
    test::on_ranks(2, [&](test::ThreadExchange& exchange) {
        Publisher publisher(shown);
        LiveParts parts = live({.parts = 2}, LivePolicy::every_frame, exchange, publisher);
        const bool is_second = exchange.rank() == 1;
        EXPECT_TRUE(parts.push(share_of(frame_of(0), 0, exchange.rank(), 2).frame(), 5, 0.0));
        EXPECT_EQ(
            test::refusal([&] { parts.push((is_second ? bad : test::Particles()).frame(), 6, 0.0); }).substr(0, 18),
            "rank 1: particle 1");
        EXPECT_EQ(test::refusal([&] { parts.push(ParticleFrame(), 6, 0.0); }),
                  "rank 0: frame index 6 after 6; indices must increase");
        EXPECT_EQ(test::refusal([&] { parts.push(ParticleFrame(), is_second ? 8 : 7, 0.0); }),
                  "rank 1 pushes frame 8 at time 0.000000, and rank 0 pushes frame 7 at time 0.000000: all must do the "
                  "same");
        EXPECT_EQ(test::refusal([&] { parts.push(ParticleFrame(), 9, is_second ? NAN : 0.0); }),
                  "rank 1: frame 9: simulation_time is nan; it must be finite");
        EXPECT_TRUE(parts.push(share_of(frame_of(9), 9, exchange.rank(), 2).frame(), 9, 0.0));
        parts.finish();
    });
    ASSERT_EQ(shown.indices(), (std::set<std::uint64_t>{5, 9}));
    expect_whole(settings_of_parts(), frame_of(0), shown.frames().at(5));
    expect_whole(settings_of_parts(), frame_of(9), shown.frames().at(9));
}

}  // namespace
}  // namespace meniscus
