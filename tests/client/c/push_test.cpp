// The C interface of a build without the service, through `meniscus push` and a meniscusd.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "../../server/process.hpp"
#include "handles.hpp"

namespace meniscus::test {
namespace {

using server::test::on_free_port;
using server::test::Process;

constexpr double patience = 30.0;  ///< seconds, for what comes at once

class CPush : public testing::Test {
protected:
    CPush() : process_(on_free_port()), address_(process_.address()) {
        ::setenv("MENISCUS_PROGRAM", MENISCUS_CLI, 1);
        EXPECT_EQ(meniscus_client_connect(address_.c_str(), nullptr, client_.out()), MENISCUS_OK)
            << meniscus_error_message();
    }
    ~CPush() override { ::unsetenv("MENISCUS_PROGRAM"); }

    meniscus_result try_open(std::initializer_list<std::pair<const char*, const char*>> more, CSession& session) {
        const COptions options = options_of({{"particle-radius", "0.1"}});
        for (const auto& [name, value] : more) EXPECT_EQ(meniscus_options_set(options.get(), name, value), MENISCUS_OK);
        return meniscus_session_open(client_.get(), options.get(), session.out());
    }
    CSession open(std::initializer_list<std::pair<const char*, const char*>> more = {}) {
        CSession session;
        EXPECT_EQ(try_open(more, session), MENISCUS_OK) << meniscus_error_message();
        return session;
    }
    /// Pushes a row of particles.
    static meniscus_result push(const CSession& session, std::size_t count, std::uint64_t index, double time = 0.0) {
        std::vector<double> positions;
        std::vector<float> speeds;
        for (std::size_t i = 0; i < count; ++i) {
            positions.insert(positions.end(), {0.2 * static_cast<double>(i), 0.0, 0.0});
            speeds.push_back(static_cast<float>(i));
        }
        const meniscus_array speed{"speed", MENISCUS_FLOAT32, 1, speeds.data()};
        meniscus_particles frame = MENISCUS_PARTICLES_INIT;
        frame.count = count;
        frame.positions_double = positions.data();
        frame.arrays = &speed;
        frame.array_count = 1;
        return meniscus_session_push(session.get(), &frame, index, time);
    }

    Process process_;
    std::string address_;
    CClient client_;
};

TEST_F(CPush, GivesTheFiguresOfEachFrameInOrder) {
    const CSession session =
        open({{"attribute", "speed"}, {"domain", "-1 -1 -1 1e3 1 1"}, {"name", "a row"}, {"normals", "false"}});
    EXPECT_EQ(std::string(meniscus_session_id(session.get())).size(), 36U);
    for (std::uint64_t i = 0; i < 3; ++i)
        ASSERT_EQ(push(session, 10 + i, 5 * i, 0.25 * static_cast<double>(i)), MENISCUS_OK) << meniscus_error_message();
    ASSERT_EQ(meniscus_session_finish(session.get()), MENISCUS_OK);
    CFrame frame;
    for (std::uint64_t i = 0; i < 3; ++i) {
        ASSERT_EQ(meniscus_session_next(session.get(), i == 1 ? -1.0 : patience, frame.out()), MENISCUS_OK)
            << meniscus_error_message();
        std::uint64_t index = 0;
        double time = 0.0;
        EXPECT_EQ(meniscus_frame_index(frame.get(), &index), MENISCUS_OK);
        EXPECT_EQ(meniscus_frame_simulation_time(frame.get(), &time), MENISCUS_OK);
        EXPECT_EQ(index, 5 * i);
        EXPECT_EQ(time, 0.25 * static_cast<double>(i));
        meniscus_statistics statistics = MENISCUS_STATISTICS_INIT;
        ASSERT_EQ(meniscus_frame_statistics(frame.get(), &statistics), MENISCUS_OK);
        EXPECT_EQ(statistics.particles, 10 + i);
        EXPECT_GT(statistics.triangles, 0U);
        EXPECT_EQ(statistics.triangles_by_level[0] + statistics.triangles_by_level[1] +
                      statistics.triangles_by_level[2] + statistics.triangles_by_level[3],
                  statistics.triangles);
        EXPECT_GT(statistics.volume, 0.0);
        EXPECT_GT(statistics.total_seconds, 0.0);
        EXPECT_GT(statistics.stage_seconds[3], 0.0);
        EXPECT_GT(statistics.latency_seconds, 0.0);
    }
    EXPECT_EQ(meniscus_session_next(session.get(), patience, frame.out()), MENISCUS_ENDED) << meniscus_error_message();
    std::uint64_t dropped = 1;
    EXPECT_EQ(meniscus_session_dropped(session.get(), &dropped), MENISCUS_OK);
    EXPECT_EQ(dropped, 0U);
}

TEST_F(CPush, DistinguishesNothingYetFromCanceled) {
    const CSession session = open();
    CFrame frame;
    EXPECT_EQ(meniscus_session_next(session.get(), 0.0, frame.out()), MENISCUS_NOTHING_YET);
    std::thread waiting([&] {
        CFrame none;
        EXPECT_EQ(meniscus_session_next(session.get(), -1.0, none.out()), MENISCUS_ENDED);
    });
    EXPECT_EQ(meniscus_session_cancel(session.get()), MENISCUS_OK);
    waiting.join();
    meniscus_result result = MENISCUS_OK;
    for (std::uint64_t i = 0; result == MENISCUS_OK; ++i) result = push(session, 1000, i);
    EXPECT_EQ(result, MENISCUS_CANCELED) << meniscus_error_message();
    EXPECT_TRUE(refused(meniscus_session_next(session.get(), std::numeric_limits<double>::quiet_NaN(), frame.out()),
                        MENISCUS_INVALID_INPUT, "timeout_seconds is nan"));
}

TEST_F(CPush, TellsTheServersRefusalWithItsCodeAgainAndAgain) {
    const CSession session = open({{"attribute", "velocity"}});
    EXPECT_EQ(push(session, 5, 0), MENISCUS_OK) << meniscus_error_message();
    CFrame frame;
    for (int i = 0; i < 2; ++i)
        EXPECT_TRUE(refused(meniscus_session_next(session.get(), patience, frame.out()), MENISCUS_INVALID_INPUT,
                            "no array 'velocity'"));
    meniscus_result result = MENISCUS_OK;
    for (std::uint64_t i = 1; result == MENISCUS_OK; ++i) result = push(session, 1000, i);
    EXPECT_TRUE(refused(result, MENISCUS_INVALID_INPUT, "no array 'velocity'"));
}

TEST_F(CPush, RefusesWhatIsWrongBeforeItIsSent) {
    CSession session;
    EXPECT_TRUE(refused(try_open({{"cell-size", "-1"}}, session), MENISCUS_INVALID_INPUT, "cell"));
    EXPECT_TRUE(
        refused(try_open({{"max-level", "1"}}, session), MENISCUS_INVALID_INPUT, "'max-level' is not known here"));
    EXPECT_TRUE(refused(try_open({{"ephemeral", "false"}}, session), MENISCUS_UNIMPLEMENTED, "option 'ephemeral'"));
    EXPECT_EQ(session.get(), nullptr);
    session = open();
    EXPECT_EQ(push(session, 1, 4), MENISCUS_OK);
    EXPECT_TRUE(refused(push(session, 1, 4), MENISCUS_INVALID_INPUT, "frame index 4 after 4"));
    EXPECT_TRUE(refused(push(session, 1, 5, std::numeric_limits<double>::infinity()), MENISCUS_INVALID_INPUT,
                        "simulation_time is inf"));
    EXPECT_EQ(push(session, 1, 5), MENISCUS_OK);
}

TEST_F(CPush, SaysWhatItCannotDo) {
    const CSession session = open();
    EXPECT_TRUE(refused(meniscus_session_try_push(session.get(), nullptr, 0, 0.0), MENISCUS_UNIMPLEMENTED,
                        "the option policy set to latest"));
    EXPECT_TRUE(refused(meniscus_session_leave(session.get()), MENISCUS_UNIMPLEMENTED, "ends with its stream"));
    ASSERT_EQ(push(session, 5, 0), MENISCUS_OK);
    CFrame frame;
    ASSERT_EQ(meniscus_session_next(session.get(), patience, frame.out()), MENISCUS_OK) << meniscus_error_message();
    const CMesh mesh = empty_mesh();
    EXPECT_TRUE(refused(meniscus_frame_mesh(frame.get(), mesh.get()), MENISCUS_UNIMPLEMENTED, "a watcher"));
}

TEST_F(CPush, SaysThatThereIsNoServerWhereTheSessionIsOpened) {
    CClient client;
    ASSERT_EQ(meniscus_client_connect("unix:/nowhere/meniscus", nullptr, client.out()), MENISCUS_OK);
    const COptions options = options_of({{"particle-radius", "0.1"}});
    CSession session;
    EXPECT_TRUE(refused(meniscus_session_open(client.get(), options.get(), session.out()), MENISCUS_UNAVAILABLE,
                        "no server at unix:/nowhere/meniscus"));
}

TEST_F(CPush, SaysThatTheProgramIsAnotherOrIsNotThere) {
    ::setenv("MENISCUS_PROGRAM", "/bin/false", 1);
    CClient client;
    ASSERT_EQ(meniscus_client_connect(address_.c_str(), nullptr, client.out()), MENISCUS_OK);
    const COptions options = options_of({{"particle-radius", "0.1"}});
    CSession session;
    EXPECT_TRUE(refused(meniscus_session_open(client.get(), options.get(), session.out()), MENISCUS_UNAVAILABLE,
                        "/bin/false push ended with exit code 1"));
    ::setenv("MENISCUS_PROGRAM", "/nowhere/meniscus", 1);
    EXPECT_TRUE(refused(meniscus_client_connect(address_.c_str(), nullptr, client.out()), MENISCUS_UNIMPLEMENTED,
                        "MENISCUS_PROGRAM (/nowhere/meniscus) nor in PATH"));
}

TEST_F(CPush, EndsWithItsHandleWhereThisProcessIgnoresTheSignalThatEndsIt) {
    auto* const before = std::signal(SIGTERM, SIG_IGN);
    {
        const CSession session = open();
        EXPECT_EQ(push(session, 1, 0), MENISCUS_OK) << meniscus_error_message();
    }
    std::signal(SIGTERM, before);
}

TEST_F(CPush, EndsTheSessionWithItsHandle) {
    std::string id;
    {
        const CSession session = open();
        id = process_.created_session();
        EXPECT_EQ(id, meniscus_session_id(session.get()));
    }
    while (const auto line = process_.line())
        if (line->find(id) != std::string::npos && line->find("deleted") != std::string::npos) return;
    FAIL() << "the session has not ended";
}

}  // namespace
}  // namespace meniscus::test
