// The C interface through a meniscusd in a process of its own.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <optional>
#include <thread>

#include "meniscus/meniscus.hpp"
#include "support/particles.hpp"
#include "through_server.hpp"

namespace meniscus::test {
namespace {

class CServer : public CThroughServer {
protected:
    CSession open(std::initializer_list<std::pair<const char*, const char*>> more = {}) {
        const COptions options = options_of({{"particle-radius", "0.025"}});
        for (const auto& [name, value] : more) EXPECT_EQ(meniscus_options_set(options.get(), name, value), MENISCUS_OK);
        CSession session;
        EXPECT_EQ(meniscus_session_open(client_.get(), options.get(), session.out()), MENISCUS_OK)
            << meniscus_error_message();
        return session;
    }
    CWatcher watch(const CSession& session) { return CThroughServer::watch(meniscus_session_id(session.get())); }
    static meniscus_result push(const CSession& session, const Particles& particles, std::uint64_t index) {
        meniscus_particles frame = MENISCUS_PARTICLES_INIT;
        frame.count = particles.count();
        frame.positions = particles.positions.data();
        return meniscus_session_push(session.get(), &frame, index, 0.5 * static_cast<double>(index));
    }
};

TEST_F(CServer, GivesTheMeshesOfTheProcessInOrder) {
    const CSession session = open();
    std::vector<std::string> expected;
    for (unsigned i = 0; i < 3; ++i) {
        const Particles particles = splash(i, 5);
        ASSERT_EQ(push(session, particles, 10 + i), MENISCUS_OK) << meniscus_error_message();
        expected.push_back(mesh_sha256(reconstruct(default_settings(), particles.frame())));
    }
    ASSERT_EQ(meniscus_session_finish(session.get()), MENISCUS_OK);
    CFrame frame;
    for (unsigned i = 0; i < 3; ++i) {
        ASSERT_EQ(meniscus_session_next(session.get(), i == 1 ? -1.0 : patience, frame.out()), MENISCUS_OK)
            << meniscus_error_message();
        std::uint64_t index = 0;
        double time = 0.0;
        EXPECT_EQ(meniscus_frame_index(frame.get(), &index), MENISCUS_OK);
        EXPECT_EQ(meniscus_frame_simulation_time(frame.get(), &time), MENISCUS_OK);
        EXPECT_EQ(index, 10U + i);
        EXPECT_EQ(time, 0.5 * (10.0 + i));
        EXPECT_EQ(sha256_of(frame), expected[i]);
        meniscus_statistics statistics = MENISCUS_STATISTICS_INIT;
        ASSERT_EQ(meniscus_frame_statistics(frame.get(), &statistics), MENISCUS_OK);
        EXPECT_EQ(statistics.particles, splash(i, 5).count());
        EXPECT_GT(statistics.encoded_bytes, 0U);
    }
    EXPECT_EQ(meniscus_session_next(session.get(), patience, frame.out()), MENISCUS_ENDED);
    EXPECT_EQ(frame.get(), nullptr);
    std::uint64_t dropped = 1;
    EXPECT_EQ(meniscus_session_dropped(session.get(), &dropped), MENISCUS_OK);
    EXPECT_EQ(dropped, 0U);
}

TEST_F(CServer, JoinsThePartsOfFramesThatSeveralSessionsPush) {
    const CSession first = open({{"parts", "2"}, {"part", "0"}, {"run", "18446744073709551615"}});
    const char* const id = meniscus_session_id(first.get());
    const CSession second = open({{"session", id}, {"parts", "2"}, {"part", "1"}, {"run", "18446744073709551615"}});
    const Particles whole = splash(1, 5);
    Particles halves[2];
    for (std::size_t i = 0; i < whole.count(); ++i)
        halves[i % 3 == 0 ? 0 : 1].add(whole.positions[3 * i], whole.positions[3 * i + 1], whole.positions[3 * i + 2]);
    ASSERT_EQ(push(first, halves[0], 4), MENISCUS_OK) << meniscus_error_message();
    ASSERT_EQ(push(second, halves[1], 4), MENISCUS_OK) << meniscus_error_message();
    CFrame frame;
    ASSERT_EQ(meniscus_session_next(second.get(), patience, frame.out()), MENISCUS_OK) << meniscus_error_message();
    meniscus_statistics statistics = MENISCUS_STATISTICS_INIT;
    ASSERT_EQ(meniscus_frame_statistics(frame.get(), &statistics), MENISCUS_OK);
    EXPECT_EQ(statistics.particles, whole.count());
    ASSERT_EQ(meniscus_session_next(first.get(), patience, frame.out()), MENISCUS_OK) << meniscus_error_message();
    EXPECT_EQ(sha256_of(frame), mesh_sha256(reconstruct(default_settings(), whole.frame())));
    for (const CSession* session : {&first, &second}) EXPECT_EQ(meniscus_session_finish(session->get()), MENISCUS_OK);
    for (const CSession* session : {&first, &second})
        EXPECT_EQ(meniscus_session_next(session->get(), patience, frame.out()), MENISCUS_ENDED);
}

TEST_F(CServer, DistinguishesNothingYetFromEnded) {
    const CSession session = open();
    const CWatcher watcher = watch(session);
    CFrame frame;
    EXPECT_EQ(meniscus_session_next(session.get(), 0.0, frame.out()), MENISCUS_NOTHING_YET);
    EXPECT_EQ(meniscus_watcher_next(watcher.get(), 0.0, frame.out()), MENISCUS_NOTHING_YET);
    EXPECT_EQ(meniscus_watcher_next(watcher.get(), 0.01, frame.out()), MENISCUS_NOTHING_YET);
    ASSERT_EQ(push(session, splash(1, 4), 0), MENISCUS_OK);
    EXPECT_EQ(meniscus_watcher_next(watcher.get(), patience, frame.out()), MENISCUS_OK) << meniscus_error_message();
    EXPECT_EQ(sha256_of(frame), mesh_sha256(reconstruct(default_settings(), splash(1, 4).frame())));
    EXPECT_EQ(meniscus_watcher_next(watcher.get(), 0.0, frame.out()), MENISCUS_NOTHING_YET);
    ASSERT_EQ(meniscus_client_delete_session(client_.get(), meniscus_session_id(session.get())), MENISCUS_OK);
    EXPECT_EQ(meniscus_watcher_next(watcher.get(), patience, frame.out()), MENISCUS_ENDED) << meniscus_error_message();
    EXPECT_TRUE(refused(meniscus_session_next(session.get(), std::numeric_limits<double>::quiet_NaN(), frame.out()),
                        MENISCUS_INVALID_INPUT, "timeout_seconds is nan"));
}

TEST_F(CServer, AnAttemptToPushTakesAFrameWholeOrNotAtAll) {
    const CSession session = open({{"waiting-limit", "1"}});
    const Particles particles = splash(1, 3);
    meniscus_particles input = MENISCUS_PARTICLES_INIT;
    input.count = particles.count();
    input.positions = particles.positions.data();
    std::uint64_t taken = 0;
    meniscus_result result = MENISCUS_OK;
    // Frames that wait for next() fill the room at last.
    while (taken < 100 && result == MENISCUS_OK) {
        result = meniscus_session_try_push(session.get(), &input, taken, 0.0);
        if (result == MENISCUS_OK) ++taken;
    }
    EXPECT_EQ(result, MENISCUS_WOULD_WAIT);
    ASSERT_GT(taken, 0U);
    EXPECT_EQ(meniscus_session_finish(session.get()), MENISCUS_OK);
    CFrame frame;
    for (std::uint64_t i = 0; i < taken; ++i) {
        ASSERT_EQ(meniscus_session_next(session.get(), patience, frame.out()), MENISCUS_OK);
        std::uint64_t index = 0;
        EXPECT_EQ(meniscus_frame_index(frame.get(), &index), MENISCUS_OK);
        EXPECT_EQ(index, i);
    }
    EXPECT_EQ(meniscus_session_next(session.get(), patience, frame.out()), MENISCUS_ENDED);
}

TEST_F(CServer, GivesVerticesWhatParticlesCarry) {
    const CSession session = open({{"attribute", "age"}, {"attribute-bits", "0"}});
    const COptions watch_options = options_of({{"attribute", "all"}});
    CWatcher watcher;
    ASSERT_EQ(
        meniscus_watcher_open(client_.get(), meniscus_session_id(session.get()), watch_options.get(), watcher.out()),
        MENISCUS_OK)
        << meniscus_error_message();
    const Particles particles = splash(1, 5);
    const std::vector<float> ages(particles.count(), 0.7F);
    const meniscus_array array{"age", MENISCUS_FLOAT32, 1, ages.data()};
    meniscus_particles input = MENISCUS_PARTICLES_INIT;
    input.count = particles.count();
    input.positions = particles.positions.data();
    EXPECT_TRUE(refused(meniscus_session_push(session.get(), &input, 0, 0.0), MENISCUS_INVALID_INPUT,
                        "no array 'age', which the session's settings name"));
    input.array_count = 1;
    input.arrays = &array;
    ASSERT_EQ(meniscus_session_push(session.get(), &input, 0, 0.0), MENISCUS_OK) << meniscus_error_message();
    CFrame answered;
    CFrame watched;
    ASSERT_EQ(meniscus_session_next(session.get(), patience, answered.out()), MENISCUS_OK) << meniscus_error_message();
    ASSERT_EQ(meniscus_watcher_next(watcher.get(), patience, watched.out()), MENISCUS_OK) << meniscus_error_message();
    for (const meniscus_frame* frame : {answered.get(), watched.get()}) {
        const CMesh mesh = empty_mesh();
        ASSERT_EQ(meniscus_frame_mesh(frame, mesh.get()), MENISCUS_OK) << meniscus_error_message();
        const meniscus_array* attributes = nullptr;
        const double* vertices = nullptr;
        std::size_t count = 0;
        std::size_t vertex_count = 0;
        ASSERT_EQ(meniscus_mesh_attributes(mesh.get(), &attributes, &count), MENISCUS_OK);
        ASSERT_EQ(meniscus_mesh_vertices(mesh.get(), &vertices, &vertex_count), MENISCUS_OK);
        ASSERT_EQ(count, 1U);
        EXPECT_STREQ(attributes[0].name, "age");
        ASSERT_GT(vertex_count, 0U);
        for (std::size_t i = 0; i < vertex_count; ++i)
            ASSERT_EQ(static_cast<const float*>(attributes[0].data)[i], 0.7F);
    }
    const COptions wrong = options_of({{"attribute-bits", "17"}});
    CWatcher none;
    EXPECT_TRUE(
        refused(meniscus_watcher_open(client_.get(), meniscus_session_id(session.get()), wrong.get(), none.out()),
                MENISCUS_INVALID_INPUT, "option 'attribute-bits' is '17', must be 1 to 16, or 0"));
}

TEST_F(CServer, ASessionEndsWithItsHandleUnlessItIsLeftOrJoined) {
    CSession session = open({{"name", "dam"}, {"up-axis", "z"}, {"length-unit", "m"}});
    const std::string ended = meniscus_session_id(session.get());
    EXPECT_TRUE(is_there(ended));
    session = {};
    EXPECT_FALSE(is_there(ended));

    session = open({{"ephemeral", "false"}});
    const std::string left = meniscus_session_id(session.get());
    ASSERT_EQ(meniscus_session_leave(session.get()), MENISCUS_OK);
    session = {};
    EXPECT_TRUE(is_there(left));
    session = open({{"session", left.c_str()}});
    EXPECT_EQ(meniscus_session_id(session.get()), left);
    session = {};
    EXPECT_TRUE(is_there(left));
    EXPECT_EQ(meniscus_client_delete_session(client_.get(), left.c_str()), MENISCUS_OK);
    EXPECT_TRUE(refused(meniscus_client_delete_session(client_.get(), left.c_str()), MENISCUS_NOT_FOUND, left));
}

TEST_F(CServer, CancelEndsWhatWaitsInAnotherThread) {
    const CSession session = open();
    const CWatcher watcher = watch(session);
    std::thread canceling([&] {
        EXPECT_EQ(meniscus_watcher_cancel(watcher.get()), MENISCUS_OK);
        EXPECT_EQ(meniscus_session_cancel(session.get()), MENISCUS_OK);
    });
    CFrame frame;
    EXPECT_EQ(meniscus_watcher_next(watcher.get(), patience, frame.out()), MENISCUS_ENDED) << meniscus_error_message();
    EXPECT_EQ(meniscus_session_next(session.get(), patience, frame.out()), MENISCUS_ENDED) << meniscus_error_message();
    canceling.join();
    EXPECT_EQ(push(session, splash(1, 3), 0), MENISCUS_CANCELED) << meniscus_error_message();
}

TEST_F(CServer, AFrameThatIsRefusedLeavesTheHandlesSafeToUse) {
    const CSession session = open();
    Particles bad = splash(2, 3);
    bad.positions[4] = std::numeric_limits<float>::infinity();
    // Either side may notice first: the library, or the server, whose answer comes with a later call.
    meniscus_result result = push(session, bad, 0);
    CFrame frame;
    if (result == MENISCUS_OK) result = meniscus_session_next(session.get(), patience, frame.out());
    EXPECT_TRUE(refused(result, MENISCUS_INVALID_INPUT, "particle 1 has y = inf"));
    for (int again = 0; again < 2; ++again) {
        static_cast<void>(push(session, splash(2, 3), 1));
        static_cast<void>(meniscus_session_finish(session.get()));
        static_cast<void>(meniscus_session_next(session.get(), 0.0, frame.out()));
    }
    const CSession next = open();
    EXPECT_EQ(push(next, splash(2, 3), 0), MENISCUS_OK);
    EXPECT_EQ(meniscus_session_next(next.get(), patience, frame.out()), MENISCUS_OK) << meniscus_error_message();
}

TEST_F(CServer, RefusesWrongOptionsAndNulls) {
    const auto refusal = [&](std::initializer_list<std::pair<const char*, const char*>> values) {
        CSession session;
        return meniscus_session_open(client_.get(), options_of(values).get(), session.out());
    };
    EXPECT_TRUE(refused(refusal({}), MENISCUS_INVALID_INPUT, "option 'particle-radius' is not set"));
    EXPECT_TRUE(refused(refusal({{"particle-radius", "1"}, {"policy", "first"}}), MENISCUS_INVALID_INPUT,
                        "option 'policy' is 'first', must be every-frame, latest or every-nth"));
    EXPECT_TRUE(refused(refusal({{"particle-radius", "1"}, {"codec", "zip"}}), MENISCUS_INVALID_INPUT,
                        "option 'codec' is 'zip', must be entropy, packed or draco"));
    EXPECT_TRUE(refused(refusal({{"particle-radius", "1"}, {"reconnect", "-1"}}), MENISCUS_INVALID_INPUT,
                        "option 'reconnect' is '-1', must be 0 to"));
    EXPECT_TRUE(refused(refusal({{"particle-radius", "1"}, {"threads", "2"}}), MENISCUS_INVALID_INPUT,
                        "option 'threads' is not known here"));
    EXPECT_TRUE(refused(refusal({{"particle-radius", "1"}, {"session", "no id"}}), MENISCUS_INVALID_INPUT, "no id"));

    CSession session;
    CWatcher watcher;
    CFrame frame;
    const CSession good = open();
    const CWatcher watching = watch(good);
    const meniscus_particles particles = MENISCUS_PARTICLES_INIT;
    std::uint64_t index = 0;
    const COptions options = options_of({{"particle-radius", "1"}});
    const meniscus_result results[] = {
        meniscus_client_connect(nullptr, nullptr, client_.out()),
        meniscus_client_connect(address_.c_str(), nullptr, nullptr),
        meniscus_session_open(nullptr, options.get(), session.out()),
        meniscus_client_delete_session(nullptr, "x"),
        meniscus_session_push(nullptr, &particles, 0, 0.0),
        meniscus_session_push(good.get(), nullptr, 0, 0.0),
        meniscus_session_try_push(nullptr, &particles, 0, 0.0),
        meniscus_session_try_push(good.get(), nullptr, 0, 0.0),
        meniscus_session_finish(nullptr),
        meniscus_session_leave(nullptr),
        meniscus_session_cancel(nullptr),
        meniscus_session_next(nullptr, 0.0, frame.out()),
        meniscus_session_next(good.get(), 0.0, nullptr),
        meniscus_watcher_open(nullptr, "x", nullptr, watcher.out()),
        meniscus_watcher_next(nullptr, 0.0, frame.out()),
        meniscus_watcher_next(watching.get(), 0.0, nullptr),
        meniscus_watcher_cancel(nullptr),
        meniscus_frame_index(nullptr, &index),
        meniscus_frame_mesh(nullptr, empty_mesh().get()),
    };
    for (const meniscus_result result : results) EXPECT_TRUE(refused(result, MENISCUS_INVALID_INPUT, "is NULL"));
    EXPECT_EQ(meniscus_session_id(nullptr), nullptr);
    meniscus_session_destroy(nullptr);
    meniscus_watcher_destroy(nullptr);
    meniscus_frame_destroy(nullptr);
    meniscus_client_destroy(nullptr);
}

TEST_F(CServer, HandlesOutliveTheirClientAndTheServer) {
    CSession session = open();
    CWatcher watcher = watch(session);
    ASSERT_EQ(push(session, splash(3, 3), 0), MENISCUS_OK);
    CFrame kept;
    ASSERT_EQ(meniscus_watcher_next(watcher.get(), patience, kept.out()), MENISCUS_OK);
    client_ = {};
    process_.signal(SIGKILL);
    CFrame frame;
    EXPECT_EQ(meniscus_watcher_next(watcher.get(), patience, frame.out()), MENISCUS_UNAVAILABLE)
        << meniscus_error_message();
    watcher = {};
    session = {};
    EXPECT_EQ(sha256_of(kept), mesh_sha256(reconstruct(default_settings(), splash(3, 3).frame())));
}

TEST(CClientWithoutServer, IsUnavailableAndSaysWhere) {
    CClient client;
    EXPECT_TRUE(
        refused(meniscus_client_connect("127.0.0.1:1", nullptr, client.out()), MENISCUS_UNAVAILABLE, "127.0.0.1:1"));
    EXPECT_EQ(client.get(), nullptr);
}

}  // namespace
}  // namespace meniscus::test
