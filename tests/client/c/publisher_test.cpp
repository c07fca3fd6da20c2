// The C interface: surfaces that are made in this process, for the watchers of a session of a meniscusd.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <thread>

#include "in_process.hpp"
#include "meniscus/brick_box.hpp"
#include "meniscus/mesh_hash.hpp"
#include "through_server.hpp"

namespace meniscus::test {
namespace {

class CPublishers : public CThroughServer {
protected:
    CPublisher open(std::initializer_list<std::pair<const char*, const char*>> more = {}) {
        const COptions options = options_of({{"particle-radius", "0.025"}});
        for (const auto& [name, value] : more) EXPECT_EQ(meniscus_options_set(options.get(), name, value), MENISCUS_OK);
        CPublisher publisher;
        EXPECT_EQ(meniscus_publisher_open(client_.get(), options.get(), publisher.out()), MENISCUS_OK)
            << meniscus_error_message();
        return publisher;
    }
    CWatcher watch(const CPublisher& publisher) {
        return CThroughServer::watch(meniscus_publisher_session_id(publisher.get()));
    }
    static meniscus_statistics statistics_of(const CFrame& frame) {
        meniscus_statistics statistics = MENISCUS_STATISTICS_INIT;
        EXPECT_EQ(meniscus_frame_statistics(frame.get(), &statistics), MENISCUS_OK);
        return statistics;
    }
};

CReconstructor publishing_reconstructor() {
    return reconstructor_of({{"particle-radius", "0.025"}, {"threads", "1"}, {"keep-lattice", "true"}});
}

CMesh surface_of(const CReconstructor& reconstructor, const Particles& particles) {
    CMesh mesh = empty_mesh();
    const meniscus_particles frame = c_frame(particles);
    EXPECT_EQ(meniscus_reconstruct(reconstructor.get(), &frame, mesh.get()), MENISCUS_OK) << meniscus_error_message();
    return mesh;
}

TEST_F(CPublishers, GiveWatchersTheMeshThatTheyPush) {
    const CReconstructor reconstructor = publishing_reconstructor();
    for (const char* const codec : {"packed", "entropy"}) {
        const CPublisher publisher = open({{"codec", codec}});
        const CWatcher watcher = watch(publisher);
        for (unsigned i = 0; i < 3; ++i) {
            const Particles particles = splash(i, 5);
            const CMesh mesh = surface_of(reconstructor, particles);
            ASSERT_EQ(meniscus_publisher_push(publisher.get(), mesh.get(), 10 + i, 0.5 * i), MENISCUS_OK)
                << meniscus_error_message();
            CFrame answer;
            CFrame seen;
            ASSERT_EQ(meniscus_publisher_next(publisher.get(), i == 1 ? -1.0 : patience, answer.out()), MENISCUS_OK)
                << meniscus_error_message();
            ASSERT_EQ(meniscus_watcher_next(watcher.get(), patience, seen.out()), MENISCUS_OK)
                << meniscus_error_message();
            meniscus_statistics own = MENISCUS_STATISTICS_INIT;
            ASSERT_EQ(meniscus_reconstructor_statistics(reconstructor.get(), &own), MENISCUS_OK);
            for (const CFrame* frame : {&answer, &seen}) {
                std::uint64_t index = 0;
                double time = 0.0;
                EXPECT_EQ(meniscus_frame_index(frame->get(), &index), MENISCUS_OK);
                EXPECT_EQ(meniscus_frame_simulation_time(frame->get(), &time), MENISCUS_OK);
                EXPECT_EQ(index, 10U + i);
                EXPECT_EQ(time, 0.5 * i);
                EXPECT_EQ(statistics_of(*frame).triangles, own.triangles);
                EXPECT_EQ(statistics_of(*frame).volume, own.volume);
            }
            EXPECT_EQ(sha256_of(seen), sha256(mesh));
        }
        EXPECT_EQ(meniscus_publisher_finish(publisher.get()), MENISCUS_OK);
        CFrame frame;
        EXPECT_EQ(meniscus_publisher_next(publisher.get(), patience, frame.out()), MENISCUS_ENDED)
            << meniscus_error_message();
        std::uint64_t dropped = 1;
        EXPECT_EQ(meniscus_publisher_dropped(publisher.get(), &dropped), MENISCUS_OK);
        EXPECT_EQ(dropped, 0U);
    }
}

TEST_F(CPublishers, OfBricksThatEachHasAloneMakeOneSurface) {
    Particles bodies[2];
    Particles whole;
    for (std::size_t b = 0; b < 2; ++b) {
        const Particles body = splash(3, 5);
        for (std::size_t i = 0; i < body.count(); ++i)
            for (Particles* to : {&bodies[b], &whole})
                to->add(body.positions[3 * i] + 8.0F * static_cast<float>(b), body.positions[3 * i + 1],
                        body.positions[3 * i + 2]);
    }
    const CPublisher first = open({{"parts", "2"}, {"part", "0"}, {"run", "77"}});
    const CPublisher second =
        open({{"session", meniscus_publisher_session_id(first.get())}, {"parts", "2"}, {"part", "1"}, {"run", "77"}});
    const CWatcher watcher = watch(first);
    const CReconstructor reconstructor = publishing_reconstructor();
    for (std::size_t b = 0; b < 2; ++b)
        ASSERT_EQ(meniscus_publisher_push((b == 0 ? first : second).get(), surface_of(reconstructor, bodies[b]).get(),
                                          4, 1.0),
                  MENISCUS_OK)
            << meniscus_error_message();
    CFrame seen;
    ASSERT_EQ(meniscus_watcher_next(watcher.get(), patience, seen.out()), MENISCUS_OK) << meniscus_error_message();
    EXPECT_EQ(sha256_of(seen), mesh_sha256(reconstruct(default_settings(), whole.frame())));
    for (const CPublisher* publisher : {&first, &second}) {
        CFrame answer;
        ASSERT_EQ(meniscus_publisher_next(publisher->get(), patience, answer.out()), MENISCUS_OK)
            << meniscus_error_message();
        EXPECT_EQ(statistics_of(answer).particles, whole.count());
    }
}

TEST_F(CPublishers, OfTheirOwnBricksOfMeshesThatOverlapMakeOneSurface) {
    const Particles whole = splash(3, 24);
    const Mesh expected = reconstruct(default_settings(), whole.frame());
    constexpr std::int32_t below = std::numeric_limits<std::int32_t>::min();
    constexpr std::int32_t above = std::numeric_limits<std::int32_t>::max();
    // Cut before brick 1 along x, and in the second part before brick 1 along y.
    const std::int32_t lowest[3][3] = {{below, below, below}, {1, below, below}, {1, 1, below}};
    const std::int32_t highest[3][3] = {{0, above, above}, {above, 0, above}, {above, above, above}};
    const double edge = 64 * 0.5 * 0.025;
    const double reach = halo(default_settings()) * 0.025;
    const CReconstructor reconstructor = publishing_reconstructor();
    CPublisher publishers[3];
    publishers[0] = open({{"parts", "3"}, {"part", "0"}, {"run", "78"}});
    for (unsigned p = 1; p < 3; ++p)
        publishers[p] = open({{"session", meniscus_publisher_session_id(publishers[0].get())},
                              {"parts", "3"},
                              {"part", p == 1 ? "1" : "2"},
                              {"run", "78"}});
    const CWatcher watcher = watch(publishers[0]);
    for (unsigned p = 0; p < 3; ++p) {
        Particles mine;
        for (std::size_t i = 0; i < whole.count(); ++i) {
            const float* const at = &whole.positions[3 * i];
            bool is_near = true;
            for (unsigned axis = 0; axis < 3; ++axis)
                is_near &=
                    at[axis] >= lowest[p][axis] * edge - reach && at[axis] <= (highest[p][axis] + 1.0) * edge + reach;
            if (is_near) mine.add(at[0], at[1], at[2]);
        }
        ASSERT_EQ(meniscus_publisher_push_box(publishers[p].get(), surface_of(reconstructor, mine).get(), lowest[p],
                                              highest[p], 4, 1.0),
                  MENISCUS_OK)
            << meniscus_error_message();
    }
    CFrame seen;
    ASSERT_EQ(meniscus_watcher_next(watcher.get(), patience, seen.out()), MENISCUS_OK) << meniscus_error_message();
    EXPECT_EQ(sha256_of(seen), mesh_sha256(expected));
    CFrame answer;
    ASSERT_EQ(meniscus_publisher_next(publishers[2].get(), patience, answer.out()), MENISCUS_OK)
        << meniscus_error_message();
    EXPECT_EQ(statistics_of(answer).triangles, expected.triangles.size());
    EXPECT_EQ(statistics_of(answer).vertices, expected.vertices.size());
    const std::int32_t high[3] = {1, 1, 1};
    const std::int32_t low[3] = {0, 2, 0};
    const CMesh mesh = surface_of(reconstructor, splash(2, 3));
    EXPECT_TRUE(refused(meniscus_publisher_push_box(publishers[0].get(), mesh.get(), low, high, 5, 0.0),
                        MENISCUS_INVALID_INPUT, "the box of bricks runs from (0, 2, 0) to (1, 1, 1)"));
    EXPECT_TRUE(refused(meniscus_publisher_push_box(publishers[0].get(), mesh.get(), nullptr, high, 5, 0.0),
                        MENISCUS_INVALID_INPUT, "lowest is NULL"));
    EXPECT_TRUE(refused(meniscus_publisher_push_box(publishers[0].get(), mesh.get(), low, nullptr, 5, 0.0),
                        MENISCUS_INVALID_INPUT, "highest is NULL"));
}

TEST_F(CPublishers, RefuseMeshesWithoutTheirLatticeAndGoOn) {
    const CPublisher publisher = open();
    const Particles particles = splash(2, 4);
    const CMesh without = surface_of(default_reconstructor(), particles);
    EXPECT_TRUE(refused(meniscus_publisher_push(publisher.get(), without.get(), 0, 0.0), MENISCUS_INVALID_INPUT,
                        "frame 0: the mesh has no lattice"));
    const CMesh mesh = surface_of(publishing_reconstructor(), particles);
    ASSERT_EQ(meniscus_publisher_push(publisher.get(), mesh.get(), 0, 0.0), MENISCUS_OK) << meniscus_error_message();
    CFrame answer;
    ASSERT_EQ(meniscus_publisher_next(publisher.get(), patience, answer.out()), MENISCUS_OK)
        << meniscus_error_message();
    // One that was received has none.
    const CWatcher watcher = watch(publisher);
    ASSERT_EQ(meniscus_watcher_next(watcher.get(), patience, answer.out()), MENISCUS_OK) << meniscus_error_message();
    ASSERT_EQ(meniscus_frame_mesh(answer.get(), mesh.get()), MENISCUS_OK) << meniscus_error_message();
    EXPECT_TRUE(refused(meniscus_publisher_push(publisher.get(), mesh.get(), 1, 0.0), MENISCUS_INVALID_INPUT,
                        "frame 1: the mesh has no lattice"));
}

TEST_F(CPublishers, EndTheirSessionUnlessItIsLeft) {
    CPublisher publisher = open();
    const std::string ended = meniscus_publisher_session_id(publisher.get());
    EXPECT_TRUE(is_there(ended));
    publisher = {};
    EXPECT_FALSE(is_there(ended));
    publisher = open({{"ephemeral", "false"}});
    const std::string left = meniscus_publisher_session_id(publisher.get());
    EXPECT_EQ(meniscus_publisher_leave(publisher.get()), MENISCUS_OK);
    publisher = {};
    EXPECT_TRUE(is_there(left));
    EXPECT_EQ(meniscus_client_delete_session(client_.get(), left.c_str()), MENISCUS_OK);
}

TEST_F(CPublishers, AreCanceledFromAnotherThread) {
    const CPublisher publisher = open();
    std::thread canceling([&] { EXPECT_EQ(meniscus_publisher_cancel(publisher.get()), MENISCUS_OK); });
    CFrame frame;
    EXPECT_EQ(meniscus_publisher_next(publisher.get(), patience, frame.out()), MENISCUS_ENDED)
        << meniscus_error_message();
    canceling.join();
    const CMesh mesh = surface_of(publishing_reconstructor(), splash(2, 3));
    EXPECT_EQ(meniscus_publisher_push(publisher.get(), mesh.get(), 0, 0.0), MENISCUS_CANCELED)
        << meniscus_error_message();
}

TEST_F(CPublishers, RefuseWrongOptionsAndNulls) {
    const auto refusal = [&](std::initializer_list<std::pair<const char*, const char*>> values) {
        CPublisher publisher;
        return meniscus_publisher_open(client_.get(), options_of(values).get(), publisher.out());
    };
    EXPECT_TRUE(refused(refusal({}), MENISCUS_INVALID_INPUT, "option 'particle-radius' is not set"));
    EXPECT_TRUE(refused(refusal({{"particle-radius", "1"}, {"codec", "zip"}}), MENISCUS_INVALID_INPUT,
                        "option 'codec' is 'zip'"));
    EXPECT_TRUE(refused(refusal({{"particle-radius", "1"}, {"attribute-bits", "17"}}), MENISCUS_INVALID_INPUT,
                        "option 'attribute-bits' is '17', must be 1 to 16, or 0"));
    EXPECT_TRUE(refused(refusal({{"particle-radius", "1"}, {"parts", "2"}}), MENISCUS_INVALID_INPUT,
                        "run is 0, and parts is 2"));
    EXPECT_TRUE(refused(refusal({{"particle-radius", "1"}, {"meshes", "false"}}), MENISCUS_INVALID_INPUT,
                        "option 'meshes' is not known here"));

    const CPublisher good = open();
    const CMesh mesh = empty_mesh();
    CPublisher publisher;
    CFrame frame;
    std::uint64_t dropped = 0;
    const meniscus_result results[] = {
        meniscus_publisher_open(nullptr, nullptr, publisher.out()),
        meniscus_publisher_open(client_.get(), nullptr, nullptr),
        meniscus_publisher_push(nullptr, mesh.get(), 0, 0.0),
        meniscus_publisher_push(good.get(), nullptr, 0, 0.0),
        meniscus_publisher_finish(nullptr),
        meniscus_publisher_leave(nullptr),
        meniscus_publisher_cancel(nullptr),
        meniscus_publisher_next(nullptr, 0.0, frame.out()),
        meniscus_publisher_next(good.get(), 0.0, nullptr),
        meniscus_publisher_dropped(nullptr, &dropped),
        meniscus_publisher_dropped(good.get(), nullptr),
    };
    for (const meniscus_result result : results) EXPECT_TRUE(refused(result, MENISCUS_INVALID_INPUT, "is NULL"));
    EXPECT_EQ(meniscus_publisher_session_id(nullptr), nullptr);
    meniscus_publisher_destroy(nullptr);
}

}  // namespace
}  // namespace meniscus::test
