// libcatalyst-meniscus.so in a simulation of several ranks under mpirun.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "../c/through_server.hpp"
#include "../mpi/mpi_process.hpp"
#include "meniscus/meniscus.hpp"
#include "support/particles.hpp"

namespace meniscus::test {
namespace {

constexpr const char* session_id = "6f1c2f0e-5a52-4a86-9c6b-0f8f5f0a4242";

/// catalyst_simulation under mpirun, step by step.
class Simulation {
public:
    /// last: an option of the last rank alone; null for none.
    Simulation(int ranks, const std::string& implementation, const std::string& options, const char* last = nullptr)
        : process_(ranks, command(implementation, options, last)) {}

    struct Answer {
        int best = -1;    ///< the smallest status of a rank
        int status = -1;  ///< the largest
        long sent = -1;
    };
    Answer answer() {
        Answer answer;
        EXPECT_EQ(std::fscanf(process_.output(), "%d %d %ld", &answer.best, &answer.status, &answer.sent), 3);
        return answer;
    }
    Answer execute(std::int64_t step) {
        process_.write(std::to_string(step) + "\n");
        return answer();
    }
    /// After it comes finalize's answer.
    void end() { process_.end_input(); }

private:
    static std::vector<std::string> command(const std::string& implementation, const std::string& options,
                                            const char* last) {
        ::setenv("CATALYST_IMPLEMENTATION_NAME", "meniscus", 1);
        ::setenv("CATALYST_IMPLEMENTATION_PATHS", implementation.c_str(), 1);
        ::setenv("MENISCUS_CATALYST", options.c_str(), 1);
        std::vector<std::string> words{MENISCUS_SIMULATION};
        if (last != nullptr) words.emplace_back(last);
        return words;
    }

    MpiProcess process_;
};

class CatalystRanks : public CThroughServer {
protected:
    std::string options() const {
        return "server=" + address_ + " particle-radius=0.025 policy=every-frame session=" + session_id;
    }
    /// All frames so far have been sent.
    static void execute_well(Simulation& simulation, std::int64_t step) {
        const auto answer = simulation.execute(step);
        EXPECT_EQ(answer.status, 0);
        EXPECT_EQ(answer.sent, step);
    }
    void expect_frame(const CWatcher& watcher, std::int64_t step) {
        CFrame frame;
        ASSERT_EQ(meniscus_watcher_next(watcher.get(), patience, frame.out()), MENISCUS_OK) << meniscus_error_message();
        std::uint64_t index = 0;
        EXPECT_EQ(meniscus_frame_index(frame.get(), &index), MENISCUS_OK);
        EXPECT_EQ(index, static_cast<std::uint64_t>(step));
        const Particles whole = splash(static_cast<unsigned>(step), 5);
        EXPECT_EQ(sha256_of(frame), mesh_sha256(reconstruct(default_settings(), whole.frame())));
    }
};

TEST_F(CatalystRanks, PushTheFramesOfOneProcessInParts) {
    Simulation simulation(4, MENISCUS_CATALYST_OF_RANKS, options());
    ASSERT_EQ(simulation.answer().status, 0);
    const CWatcher watcher = watch(session_id);
    for (std::int64_t step = 1; step <= 5; ++step) {
        execute_well(simulation, step);
        expect_frame(watcher, step);
    }
    simulation.end();
    EXPECT_EQ(simulation.answer().status, 0);
}

// Each is shown with the next one.
TEST_F(CatalystRanks, MakeTheSurfaceOfOneProcessThemselves) {
    for (const char* const makers : {"all", "node", "2"}) {
        Simulation simulation(4, MENISCUS_CATALYST_OF_RANKS, options() + " threads=1 reconstruct-ranks=" + makers);
        ASSERT_EQ(simulation.answer().status, 0);
        const CWatcher watcher = watch(session_id);
        for (std::int64_t step = 1; step <= 5; ++step) {
            execute_well(simulation, step);
            if (step > 1) expect_frame(watcher, step - 1);
        }
        simulation.end();
        expect_frame(watcher, 5);
        EXPECT_EQ(simulation.answer().status, 0);
    }
}

TEST_F(CatalystRanks, MakeSurfacesAgainAfterTheSessionHasBeenEnded) {
    Simulation simulation(3, MENISCUS_CATALYST_OF_RANKS, options() + " threads=1 reconstruct-ranks=all");
    ASSERT_EQ(simulation.answer().status, 0);
    ASSERT_EQ(simulation.execute(1).sent, 1);
    ASSERT_EQ(simulation.execute(2).sent, 2);
    ASSERT_EQ(meniscus_client_delete_session(client_.get(), session_id), MENISCUS_OK) << meniscus_error_message();
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    std::int64_t step = 3;
    // It is there again with the frame that is published next after one that was lost.
    CWatcher watcher;
    meniscus_result result = MENISCUS_NOT_FOUND;
    for (; result == MENISCUS_NOT_FOUND && std::chrono::steady_clock::now() < end; ++step) {
        EXPECT_EQ(simulation.execute(step).status, 0);
        result = meniscus_watcher_open(client_.get(), session_id, nullptr, watcher.out());
        if (result != MENISCUS_OK) continue;
        CFrame frame;
        result = meniscus_watcher_next(watcher.get(), patience, frame.out());
        std::uint64_t index = 0;
        if (result != MENISCUS_OK || meniscus_frame_index(frame.get(), &index) != MENISCUS_OK) continue;
        const Particles whole = splash(static_cast<unsigned>(index), 5);
        EXPECT_EQ(sha256_of(frame), mesh_sha256(reconstruct(default_settings(), whole.frame())));
    }
    EXPECT_EQ(result, MENISCUS_OK);
    simulation.end();
    EXPECT_EQ(simulation.answer().status, 0);
}

TEST_F(CatalystRanks, AreRefusedWhereSomeAloneWouldMakeSurfaces) {
    Simulation simulation(3, MENISCUS_CATALYST_OF_RANKS, options(), "reconstruct-ranks=all");
    EXPECT_EQ(simulation.answer().best, 200 - MENISCUS_INVALID_INPUT);
    simulation.end();
    EXPECT_EQ(simulation.answer().status, 0);
}

TEST_F(CatalystRanks, GoOnTogetherAfterTheSessionHasBeenEnded) {
    Simulation simulation(3, MENISCUS_CATALYST_OF_RANKS, options());
    ASSERT_EQ(simulation.answer().status, 0);
    std::int64_t step = 1;
    ASSERT_EQ(simulation.execute(step++).sent, 1);
    ASSERT_EQ(meniscus_client_delete_session(client_.get(), session_id), MENISCUS_OK) << meniscus_error_message();
    // A frame may still go into the stream that ends; the session is there again once one is sent after one was not.
    Simulation::Answer answer;
    const auto until = [&](auto done) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        long before = 0;
        do {
            before = answer.sent;
            answer = simulation.execute(step++);
            EXPECT_EQ(answer.status, 0);
        } while (!done(answer.sent, before) && std::chrono::steady_clock::now() < end);
        return done(answer.sent, before);
    };
    answer.sent = 1;
    ASSERT_TRUE(until([](long sent, long before) { return sent == before; }));
    ASSERT_TRUE(until([](long sent, long before) { return sent > before; }));
    const CWatcher watcher = watch(session_id);
    expect_frame(watcher, step - 1);
    answer = simulation.execute(step);
    expect_frame(watcher, step);
    simulation.end();
    EXPECT_EQ(simulation.answer().status, 0);
}

TEST_F(CatalystRanks, AreAllRefusedWhereOneIs) {
    // By the ranks themselves, and by the library.
    for (const char* const wrong : {"part=1", "cell-size=wide"}) {
        Simulation simulation(3, MENISCUS_CATALYST_OF_RANKS, options(), wrong);
        const auto begun = simulation.answer();
        EXPECT_EQ(begun.best, 200 - MENISCUS_INVALID_INPUT);
        EXPECT_EQ(begun.status, 200 - MENISCUS_FAILED_PRECONDITION);
        EXPECT_EQ(simulation.execute(1).best, 200 - MENISCUS_FAILED_PRECONDITION);
        simulation.end();
        EXPECT_EQ(simulation.answer().status, 0);
    }
}

TEST_F(CatalystRanks, AreRefusedByABuildWithoutMpi) {
    Simulation several(2, MENISCUS_CATALYST_ALONE, options());
    EXPECT_EQ(several.answer().status, 200 - MENISCUS_UNIMPLEMENTED);
    several.end();
    Simulation one(1, MENISCUS_CATALYST_ALONE, options());
    EXPECT_EQ(one.answer().status, 0);
    EXPECT_EQ(one.execute(1).sent, 1);
}

}  // namespace
}  // namespace meniscus::test
