// Runs that go on over another stream.
#include <gtest/gtest.h>

#include "gated_session.hpp"
#include "sessions/limits/refusal.hpp"

namespace meniscus::server::test {
namespace {

using Story = std::vector<std::string>;

constexpr UploadOptions run_seven{.receive_meshes = true, .normal_bits = 8, .run_id = 7};

struct Resume : testing::Test, GatedSession {
    Resume() { gate.release(100); }
};

/// A watcher that takes every frame as soon as it is there.
struct EagerWatcher {
    explicit EagerWatcher(Session& s) : session(s) {
        watch = session.open_watch({.format = {.position_bits = 6, .normal_bits = 8}}, [this] { look(); });
        look();
    }
    ~EagerWatcher() { session.close_watch(watch); }

    void look() {
        for (;;) {
            const auto next = watch->take();
            const auto* message = std::get_if<SharedMessage>(&next);
            if (message == nullptr) return;
            v1::WatchResponse response;
            EXPECT_TRUE(response.ParseFromString(**message));
            if (response.has_frame_statistics()) shown.push_back(response.frame_statistics().frame_index());
        }
    }

    Session& session;
    std::shared_ptr<Watch> watch;
    std::vector<std::uint64_t> shown;  ///< complete once a stream has ended
};

TEST_F(Resume, TakesThePlaceOfTheStreamBefore) {
    Simulator first(session, run_seven);
    Simulator second(session, run_seven);
    EXPECT_TRUE(first.receive_story().empty());
    try {
        std::rethrow_exception(first.error);
    } catch (const Refusal& refusal) {
        EXPECT_EQ(refusal.kind(), Refusal::Kind::failed_precondition);
        EXPECT_NE(std::string(refusal.what()).find("resumed run 0000000000000007"), std::string::npos)
            << refusal.what();
    }
    session.cancel_upload(first.upload);
    second.send(0, particles);
    second.end();
    EXPECT_EQ(second.receive_story(), (Story{"0"}));
}

TEST_F(Resume, TakesNoFrameOfTheStreamBeforeAnyMore) {
    EagerWatcher watcher(session);
    Simulator first(session, run_seven);
    Simulator second(session, run_seven);
    first.send(5, particles);  // was on its way in; the second one sends it too
    second.send(4, particles);
    second.send(5, particles);
    second.end();
    EXPECT_EQ(second.receive_all(), (std::vector<std::uint64_t>{4, 5}));
    EXPECT_EQ(watcher.shown, (std::vector<std::uint64_t>{4, 5}));
}

TEST_F(Resume, IsRefusedToAnotherRunAndToAStreamOfItsOwn) {
    Simulator first(session, run_seven);
    EXPECT_THROW(Simulator(session, {.run_id = 8}), Refusal);
    EXPECT_THROW(Simulator(session, {}), Refusal);
    first.end();
    first.receive_story();
    Simulator anonymous(session, {});
    EXPECT_THROW(Simulator(session, {}), Refusal);
}

TEST_F(Resume, AnswersFinishedFramesAgainButShowsThemToWatchersOnce) {
    EagerWatcher watcher(session);
    for (const std::uint64_t first : {0U, 1U}) {
        Simulator simulator(session, run_seven);
        for (std::uint64_t i = first; i < first + 3; ++i) simulator.send(i, particles);
        simulator.end();
        EXPECT_EQ(simulator.receive_all(), (std::vector<std::uint64_t>{first, first + 1, first + 2}));
    }
    EXPECT_EQ(watcher.shown, (std::vector<std::uint64_t>{0, 1, 2, 3}));
}

TEST_F(Resume, GivesALateWatcherTheNewestFrameNotTheOneAnsweredAgain) {
    for (const std::uint64_t last : {3U, 1U}) {
        Simulator simulator(session, run_seven);
        simulator.send(last, particles);
        simulator.end();
        simulator.receive_all();
    }
    EagerWatcher watcher(session);
    Simulator another(session, run_seven);  // ends behind what the watcher asked for
    another.end();
    another.receive_all();
    EXPECT_EQ(watcher.shown, (std::vector<std::uint64_t>{3}));
}

TEST_F(Resume, ShowsTheFramesOfAnotherRunWhateverTheirIndices) {
    EagerWatcher watcher(session);
    for (const std::uint64_t run : {7U, 8U, 0U, 0U}) {
        Simulator simulator(session, {.run_id = run});
        simulator.send(0, particles);
        simulator.end();
        simulator.receive_all();
    }
    EXPECT_EQ(watcher.shown, (std::vector<std::uint64_t>{0, 0, 0, 0}));
}

TEST(ResumeObserved, ShowsARecordingEachFrameOnce) {
    struct Recorder final : SessionObserver {
        const char* product() const noexcept override { return "test"; }
        void reconstructed(const InputFrame& frame) noexcept override { particles.push_back(frame.index); }
        void encoded(std::shared_ptr<const EncodedFrame> frame) noexcept override { meshes.push_back(frame->index); }
        std::vector<std::uint64_t> particles;
        std::vector<std::uint64_t> meshes;
    };
    const auto recorder = std::make_shared<Recorder>();
    Session session({.id = id}, settings(), {}, {.reconstruct = reconstruct_on_the_cpu()},
                    {.workers = std::make_shared<WorkerPool>(1)}, {recorder});
    for (const std::uint64_t first : {0U, 1U}) {
        Simulator simulator(session, run_seven);
        for (std::uint64_t i = first; i < first + 3; ++i) simulator.send(i, wave(4, 0.0));
        simulator.end();
        simulator.receive_all();
    }
    EXPECT_EQ(recorder->particles, (std::vector<std::uint64_t>{0, 1, 2, 3}));
    EXPECT_EQ(recorder->meshes, (std::vector<std::uint64_t>{0, 1, 2, 3}));
}

TEST_F(Resume, NamesTheRunInTheMesh) {
    Simulator simulator(session, run_seven);
    simulator.send(0, particles);
    EXPECT_EQ(simulator.receive()->mesh_begin().run_id(), 7U);
}

TEST(SessionThatMoves, AnswersARunFirstThatCameInTheMeantime) {
    GatedSession gated;
    Simulator first(gated.session, run_seven);
    first.send(0, gated.particles);
    first.upload->moves = true;
    gated.session.end_upload(first.upload, std::make_exception_ptr(moved()));
    Simulator second(gated.session, {.receive_meshes = true, .normal_bits = 8, .run_id = 8});
    second.send(5, gated.particles);
    second.end();
    gated.gate.release(2);
    EXPECT_EQ(first.receive_story(), (Story{"0"}));
    EXPECT_EQ(second.receive_story(), (Story{"5"}));
    EXPECT_FALSE(second.error);
}

}  // namespace
}  // namespace meniscus::server::test
