// The C interface: ranks that make one surface together, as threads, for the watchers of a session of a meniscusd.
#include <gtest/gtest.h>

#include <atomic>
#include <barrier>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <string>

#include "in_process.hpp"
#include "meniscus/mesh_hash.hpp"
#include "support/parts.hpp"
#include "thread_ranks.hpp"
#include "through_server.hpp"

namespace meniscus::test {
namespace {

using Values = std::initializer_list<std::pair<const char*, const char*>>;

/// Those of a frame that a rank owns: dealt at random, otherwise in each frame.
Particles share_of(std::uint64_t frame, std::size_t rank, std::size_t ranks) {
    const Particles all = splash(static_cast<unsigned>(frame), 8);
    std::mt19937 random(static_cast<unsigned>(frame));
    Particles mine;
    for (std::size_t i = 0; i < all.count(); ++i)
        if (random() % ranks == rank)
            mine.add(all.positions[3 * i], all.positions[3 * i + 1], all.positions[3 * i + 2]);
    return mine;
}

/// In turn as float32 that lie together, and float64 axis by axis.
meniscus_result push(meniscus_parts* parts, const meniscus_exchange& exchange, std::uint64_t frame) {
    const Particles mine = share_of(frame, exchange.rank, exchange.ranks);
    meniscus_particles particles = c_frame(mine);
    std::vector<double> axes[3];
    if (frame % 2 == 1) {
        particles.positions = nullptr;
        for (std::size_t i = 0; i < mine.positions.size(); ++i) axes[i % 3].push_back(mine.positions[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) particles.axes_double[axis] = axes[axis].data();
    }
    return meniscus_parts_push(parts, &particles, frame, 0.25 * static_cast<double>(frame));
}

class CParts : public CThroughServer {
protected:
    static constexpr const char* session_id = "6f1c2f0e-5a52-4a86-9c6b-0f8f5f0a4254";

    COptions options(Values more = {}) const {
        COptions options = options_of({{"particle-radius", "0.025"}, {"threads", "1"}, {"cell-size", "0.25"}});
        EXPECT_EQ(meniscus_options_set(options.get(), "server", address_.c_str()), MENISCUS_OK);
        for (const auto& [name, value] : more) EXPECT_EQ(meniscus_options_set(options.get(), name, value), MENISCUS_OK);
        return options;
    }
    static std::string whole_sha256(const Particles& particles) {
        Settings settings = default_settings();
        settings.cell_size = 0.25;
        return mesh_sha256(reconstruct(settings, particles.frame()));
    }
    static std::string expected_sha256(std::uint64_t frame) {
        return whole_sha256(splash(static_cast<unsigned>(frame), 8));
    }
    void expect_frame(const CWatcher& watcher, std::uint64_t frame) {
        CFrame seen;
        ASSERT_EQ(meniscus_watcher_next(watcher.get(), patience, seen.out()), MENISCUS_OK) << meniscus_error_message();
        std::uint64_t index = 0;
        meniscus_statistics statistics = MENISCUS_STATISTICS_INIT;
        EXPECT_EQ(meniscus_frame_index(seen.get(), &index), MENISCUS_OK);
        EXPECT_EQ(meniscus_frame_statistics(seen.get(), &statistics), MENISCUS_OK);
        EXPECT_EQ(index, frame);
        EXPECT_EQ(sha256_of(seen), expected_sha256(frame));
        EXPECT_EQ(statistics.particles, splash(static_cast<unsigned>(frame), 8).count());
        EXPECT_GT(statistics.volume, 0.0);
    }
};

TEST_F(CParts, ShowWatchersTheWholesMeshOfEachFrame) {
    for (const auto& [ranks, makers] : {std::pair{1U, "node"}, {3U, "node"}, {3U, "all"}, {4U, "2"}}) {
        SCOPED_TRACE(testing::Message() << ranks << " ranks, reconstruct-ranks " << makers);
        std::barrier<> seen(static_cast<std::ptrdiff_t>(ranks));
        on_ranks(ranks, [&, among = ranks, chosen = makers](const meniscus_exchange& exchange) {
            const COptions given = options({{"reconstruct-ranks", chosen}, {"policy", "every-frame"}});
            meniscus_parts* parts = nullptr;
            ASSERT_EQ(meniscus_parts_open(&exchange, given.get(), &parts), MENISCUS_OK) << meniscus_error_message();
            std::optional<CWatcher> watcher;
            if (exchange.rank == among - 1) watcher = watch(meniscus_parts_session_id(parts));
            for (std::uint64_t frame = 0; frame < 4; ++frame) {
                EXPECT_EQ(push(parts, exchange, frame), MENISCUS_OK) << meniscus_error_message();
                if (watcher && frame != 0) expect_frame(*watcher, frame - 1);
                seen.arrive_and_wait();
            }
            std::uint64_t dropped = 1;
            EXPECT_EQ(meniscus_parts_dropped(parts, &dropped), MENISCUS_OK);
            EXPECT_EQ(dropped, 0U);
            EXPECT_EQ(meniscus_parts_free(parts), MENISCUS_OK) << meniscus_error_message();
        });
    }
}

// Parts of noise with an overlap of 1 are made again, of particles that were chosen anew while the next frame had come.
TEST_F(CParts, KeepFloat64UntilTheirFrameIsSettled) {
    constexpr std::uint64_t frames = 5;
    std::vector<Particles> noise;
    for (unsigned i = 0; i < frames; ++i)
        noise.push_back(noise_cube(i, 1200 + 300 * static_cast<int>(i % 3), 0.4, 0.025));
    std::map<std::uint64_t, std::uint64_t> taken;  // the frame's number of each step
    std::optional<CWatcher> watcher;
    std::uint64_t last = 0;
    on_ranks(3, [&](const meniscus_exchange& exchange) {
        const COptions given = options({{"reconstruct-ranks", "all"}, {"overlap", "1"}});
        meniscus_parts* parts = nullptr;
        ASSERT_EQ(meniscus_parts_open(&exchange, given.get(), &parts), MENISCUS_OK) << meniscus_error_message();
        if (exchange.rank == 0) watcher = watch(meniscus_parts_session_id(parts));
        std::uint64_t step = 0;
        for (std::uint64_t frame = 0; frame < frames; ++frame, ++step) {
            std::vector<double> positions;
            for (std::size_t i = exchange.rank; i < noise[frame].count(); i += exchange.ranks)
                for (std::size_t axis = 0; axis < 3; ++axis) positions.push_back(noise[frame].positions[3 * i + axis]);
            meniscus_particles mine = MENISCUS_PARTICLES_INIT;
            mine.count = positions.size() / 3;
            mine.positions_double = positions.data();
            meniscus_result result = MENISCUS_OK;
            while ((result = meniscus_parts_push(parts, &mine, step, 0.0)) == MENISCUS_WOULD_WAIT) ++step;
            ASSERT_EQ(result, MENISCUS_OK) << meniscus_error_message();
            if (exchange.rank == 0) taken[step] = frame;
        }
        EXPECT_EQ(meniscus_parts_free(parts), MENISCUS_OK) << meniscus_error_message();
    });
    CFrame seen;
    for (; meniscus_watcher_next(watcher->get(), patience, seen.out()) == MENISCUS_OK; seen = CFrame()) {
        EXPECT_EQ(meniscus_frame_index(seen.get(), &last), MENISCUS_OK);
        ASSERT_TRUE(taken.contains(last));
        EXPECT_EQ(sha256_of(seen), whole_sha256(noise[taken[last]]));
    }
    EXPECT_EQ(last, taken.rbegin()->first);
}

TEST_F(CParts, HaveAttributesRoundedOverOneRange) {
    const COptions watching = options_of({{"attribute", "height"}});
    std::barrier<> seen(3);
    on_ranks(3, [&](const meniscus_exchange& exchange) {
        const COptions given =
            options({{"reconstruct-ranks", "all"}, {"attribute", "height"}, {"attribute-bits", "8"}});
        meniscus_parts* parts = nullptr;
        ASSERT_EQ(meniscus_parts_open(&exchange, given.get(), &parts), MENISCUS_OK) << meniscus_error_message();
        const Particles mine = share_of(5, exchange.rank, exchange.ranks);
        std::vector<float> heights;
        for (std::size_t i = 0; i < mine.count(); ++i) heights.push_back(mine.positions[3 * i + 2]);
        const meniscus_array array{"height", MENISCUS_FLOAT32, 1, heights.data()};
        meniscus_particles particles = c_frame(mine);
        particles.arrays = &array;
        particles.array_count = 1;
        EXPECT_EQ(meniscus_parts_push(parts, &particles, 0, 0.0), MENISCUS_OK) << meniscus_error_message();
        // The frame is shown once two more are taken.
        std::uint64_t step = 1;
        for (int i = 0; i < 2; ++i)
            while (meniscus_parts_push(parts, &particles, step++, 0.0) == MENISCUS_WOULD_WAIT) {
            }
        if (exchange.rank == 2) {
            CWatcher watcher;
            CFrame frame;
            ASSERT_EQ(
                meniscus_watcher_open(client_.get(), meniscus_parts_session_id(parts), watching.get(), watcher.out()),
                MENISCUS_OK);
            ASSERT_EQ(meniscus_watcher_next(watcher.get(), patience, frame.out()), MENISCUS_OK)
                << meniscus_error_message();
            EXPECT_EQ(sha256_of(frame), expected_sha256(5));
            const CMesh mesh = empty_mesh();
            const meniscus_array* attributes = nullptr;
            std::size_t count = 0;
            EXPECT_EQ(meniscus_frame_mesh(frame.get(), mesh.get()), MENISCUS_OK);
            EXPECT_EQ(meniscus_mesh_attributes(mesh.get(), &attributes, &count), MENISCUS_OK);
            ASSERT_EQ(count, 1U);
            EXPECT_STREQ(attributes[0].name, "height");
        }
        seen.arrive_and_wait();
        EXPECT_EQ(meniscus_parts_free(parts), MENISCUS_OK) << meniscus_error_message();
    });
}

TEST_F(CParts, AreAllRefusedWhatOneIsRefused) {
    on_ranks(3, [&](const meniscus_exchange& exchange) {
        meniscus_parts* parts = nullptr;
        const bool is_wrong = exchange.rank == 1;
        const auto refusal = [&](Values wrong, Values right = {}) {
            const COptions given = options(is_wrong ? wrong : right);
            return meniscus_parts_open(&exchange, given.get(), &parts);
        };
        EXPECT_TRUE(refused(refusal({{"cell-size", "wide"}}), MENISCUS_INVALID_INPUT, "rank 1: option 'cell-size'"));
        EXPECT_TRUE(refused(refusal({{"run", "3"}}), MENISCUS_INVALID_INPUT, "rank 1: option 'run' is not known here"));
        EXPECT_TRUE(refused(refusal({{"policy", "every-nth"}}), MENISCUS_INVALID_INPUT, "rank 1: option 'policy'"));
        EXPECT_TRUE(refused(refusal({{"max-level", "2"}}), MENISCUS_INVALID_INPUT, "rank 1: option 'max-level'"));
        EXPECT_TRUE(refused(refusal({{"reconstruct-ranks", "4"}}, {{"reconstruct-ranks", "4"}}), MENISCUS_INVALID_INPUT,
                            "option 'reconstruct-ranks' is 4, must be at most the 3 ranks"));
        EXPECT_TRUE(refused(refusal({{"server", "unix:/nowhere/meniscus"}, {"reconstruct-ranks", "all"}},
                                    {{"reconstruct-ranks", "all"}}),
                            MENISCUS_UNAVAILABLE, "rank 1: no server at unix:/nowhere/meniscus"));
        EXPECT_EQ(parts, nullptr);
    });
}

TEST_F(CParts, AreRefusedOptionsThatDifferFromRankToRank) {
    on_ranks(3, [&](const meniscus_exchange& exchange) {
        meniscus_parts* parts = nullptr;
        const auto refusal = [&](const char* name, const char* value) {
            const COptions given = options(exchange.rank == 1 ? Values{{name, value}} : Values{});
            return meniscus_parts_open(&exchange, given.get(), &parts);
        };
        for (const auto& [name, value] :
             {std::pair{"reconstruct-ranks", "4"}, {"reconstruct-ranks", "2"}, {"cell-size", "0.5"}, {"overlap", "9"}})
            EXPECT_TRUE(refused(refusal(name, value), MENISCUS_INVALID_INPUT, "rank 1 has the options "))
                << name << " " << value;
        // Those of its own.
        EXPECT_EQ(refusal("memory-limit", "1000000000"), MENISCUS_OK) << meniscus_error_message();
        EXPECT_EQ(meniscus_parts_free(parts), MENISCUS_OK) << meniscus_error_message();
    });
}

TEST_F(CParts, RefuseParticlesOnAllRanksAndGoOn) {
    on_ranks(2, [&](const meniscus_exchange& exchange) {
        const COptions given = options({{"policy", "every-frame"}});
        meniscus_parts* parts = nullptr;
        ASSERT_EQ(meniscus_parts_open(&exchange, given.get(), &parts), MENISCUS_OK) << meniscus_error_message();
        EXPECT_EQ(push(parts, exchange, 0), MENISCUS_OK);
        const float place[3] = {0.0F, NAN, 0.0F};
        meniscus_particles wrong = MENISCUS_PARTICLES_INIT;
        wrong.count = exchange.rank;
        EXPECT_TRUE(refused(meniscus_parts_push(parts, &wrong, 1, 0.0), MENISCUS_INVALID_INPUT,
                            "rank 1: particles->positions, positions_double, axes and axes_double are all NULL"));
        wrong.positions = place;
        EXPECT_TRUE(
            refused(meniscus_parts_push(parts, &wrong, 2, 0.0), MENISCUS_INVALID_INPUT, "rank 1: particle 0 has"));
        EXPECT_EQ(push(parts, exchange, 3), MENISCUS_OK);
        EXPECT_EQ(meniscus_parts_free(parts), MENISCUS_OK) << meniscus_error_message();
    });
    EXPECT_TRUE(refused(meniscus_parts_push(nullptr, nullptr, 0, 0.0), MENISCUS_INVALID_INPUT, "is NULL"));
    EXPECT_EQ(meniscus_parts_free(nullptr), MENISCUS_OK);
    EXPECT_EQ(meniscus_parts_session_id(nullptr), nullptr);
}

TEST_F(CParts, GoOnOnceTheSessionHasBeenEnded) {
    std::atomic<int> failures = 0;
    std::barrier<> together(3);
    on_ranks(3, [&](const meniscus_exchange& exchange) {
        const COptions given =
            options({{"session", session_id}, {"reconstruct-ranks", "2"}, {"policy", "every-frame"}});
        meniscus_parts* parts = nullptr;
        ASSERT_EQ(meniscus_parts_open(&exchange, given.get(), &parts), MENISCUS_OK) << meniscus_error_message();
        EXPECT_EQ(push(parts, exchange, 0), MENISCUS_OK);
        if (exchange.rank == 0) {
            EXPECT_EQ(meniscus_client_delete_session(client_.get(), session_id), MENISCUS_OK);
        }
        together.arrive_and_wait();
        // Frames fail, then are left out, then come again.
        std::uint64_t frame = 1;
        meniscus_result result = MENISCUS_OK;
        while ((result = push(parts, exchange, frame++)) == MENISCUS_OK) {
        }
        EXPECT_TRUE(refused(result, MENISCUS_UNAVAILABLE, "rank "));
        while ((result = push(parts, exchange, frame++)) != MENISCUS_OK) {
            if (result < 0) ++failures;
        }
        EXPECT_EQ(push(parts, exchange, frame), MENISCUS_OK) << meniscus_error_message();
        if (exchange.rank == 2) {
            const CWatcher watcher = watch(session_id);
            CFrame seen;
            ASSERT_EQ(meniscus_watcher_next(watcher.get(), patience, seen.out()), MENISCUS_OK)
                << meniscus_error_message();
            std::uint64_t index = 0;
            EXPECT_EQ(meniscus_frame_index(seen.get(), &index), MENISCUS_OK);
            EXPECT_EQ(sha256_of(seen), expected_sha256(index));
        }
        together.arrive_and_wait();
        EXPECT_EQ(meniscus_parts_free(parts), MENISCUS_OK) << meniscus_error_message();
    });
    EXPECT_LT(failures, 10);
}

TEST(CPartsOfAServer, GoOnWhileItIsAwayAndOnceItIsBack) {
    std::string folder = (std::filesystem::temp_directory_path() / "meniscus-XXXXXX").string();
    ASSERT_NE(::mkdtemp(folder.data()), nullptr);
    const std::string address = "unix:" + folder + "/socket";
    std::optional<server::test::Process> server;
    const auto start = [&] {
        server.emplace(std::vector<std::string>{"--listen", address, "--threads", "2"});
        server->address();
    };
    start();
    std::barrier<> together(2);
    on_ranks(2, [&](const meniscus_exchange& exchange) {
        const COptions given = options_of({{"particle-radius", "0.025"},
                                           {"threads", "1"},
                                           {"wait", "3600"},
                                           {"reconstruct-ranks", "all"},
                                           {"policy", "every-frame"},
                                           {"server", address.c_str()}});
        meniscus_parts* parts = nullptr;
        ASSERT_EQ(meniscus_parts_open(&exchange, given.get(), &parts), MENISCUS_OK) << meniscus_error_message();
        std::uint64_t frame = 0;
        EXPECT_EQ(push(parts, exchange, frame++), MENISCUS_OK);
        together.arrive_and_wait();
        if (exchange.rank == 0) server.reset();
        together.arrive_and_wait();
        meniscus_result result = MENISCUS_OK;
        while ((result = push(parts, exchange, frame++)) == MENISCUS_OK) {
        }
        EXPECT_TRUE(refused(result, MENISCUS_UNAVAILABLE, "rank "));
        while (push(parts, exchange, frame++) != MENISCUS_WOULD_WAIT) {
        }
        // Another attempt fails: `wait` was for the begin.
        while ((result = push(parts, exchange, frame++)) >= 0) {
        }
        EXPECT_TRUE(refused(result, MENISCUS_UNAVAILABLE, "rank "));
        together.arrive_and_wait();
        if (exchange.rank == 0) start();
        together.arrive_and_wait();
        // The second one is begun once the first is published.
        for (int taken = 0; taken < 3;) taken = push(parts, exchange, frame++) == MENISCUS_OK ? taken + 1 : 0;
        EXPECT_EQ(meniscus_parts_free(parts), MENISCUS_OK) << meniscus_error_message();
    });
    server.reset();
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace meniscus::test
