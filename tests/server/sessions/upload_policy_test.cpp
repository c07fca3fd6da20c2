// The treatment of frames that come faster than they are reconstructed, and of those of a call that was canceled.
#include <gtest/gtest.h>

#include "gated_session.hpp"
#include "opened_upload.hpp"

namespace meniscus::server::test {
namespace {

using Story = std::vector<std::string>;

struct Policies : testing::Test, GatedSession {};

TEST_F(Policies, LatestReplacesTheFrameThatWaitsAndTellsInTheOrderOfTheFrames) {
    Simulator simulator(session, {.policy = UploadPolicy::latest});
    simulator.send(0, particles);
    wait_for_begun(1);
    for (std::uint64_t i = 1; i < 5; ++i) simulator.send(i, particles);
    simulator.end();
    gate.release(2);
    EXPECT_EQ(simulator.receive_story(), (Story{"0", "-1 replaced", "-2 replaced", "-3 replaced", "4"}));
    EXPECT_EQ(session.state().frames_dropped_replaced, 3U);
    EXPECT_EQ(session.state().frames, 2U);
}

TEST_F(Policies, EveryNthReconstructsTheFirstOfEveryN) {
    Simulator simulator(session, {.policy = UploadPolicy::every_nth, .nth = 3});
    gate.release(3);
    for (std::uint64_t i = 0; i < 8; ++i) simulator.send(10 + i, particles);
    simulator.end();
    EXPECT_EQ(simulator.receive_story(),
              (Story{"10", "-11 not nth", "-12 not nth", "13", "-14 not nth", "-15 not nth", "16", "-17 not nth"}));
    EXPECT_EQ(session.state().frames_dropped_not_nth, 5U);
}

TEST_F(Policies, EveryFrameHasNoThirdInputSlotOnceThoseOfALatestStreamHaveComeBack) {
    std::vector<InputFrame*> lent;
    const auto lend_all = [&] {
        lent.clear();
        for (int i = 0; i < 4; ++i)
            session.request_input([&](InputFrame& input) {
                lent.push_back(&input);
                return true;
            });
        return lent.size();
    };
    const auto latest = test::open_upload(session, {.policy = UploadPolicy::latest});
    EXPECT_EQ(lend_all(), 3U);
    session.end_upload(latest, nullptr);
    const auto every_frame = test::open_upload(session);
    const std::vector<InputFrame*> borrowed = std::exchange(lent, {});
    for (InputFrame* input : borrowed) session.return_input(*input);  // the request left over takes the first
    EXPECT_EQ(lent.size(), 1U);
    EXPECT_EQ(lend_all(), 1U);
}

TEST_F(Policies, SlowDownASimulatorThatDoesNotReadWhatWasDropped) {
    UnreportedDrops drops;
    int calls = 0;
    for (std::size_t i = 0; i + 1 < UnreportedDrops::limit; ++i) drops.add();
    drops.when_below_limit([&] { ++calls; });
    EXPECT_EQ(calls, 1);
    drops.add();
    for (int part = 0; part < 2; ++part) drops.when_below_limit([&] { ++calls; });
    EXPECT_EQ(calls, 1);
    drops.report();
    EXPECT_EQ(calls, 3);
}

TEST_F(Policies, ACanceledCallsFramesThatWaitAreNotReconstructed) {
    {
        Simulator simulator(session, {});
        simulator.send(0, particles);
        wait_for_begun(1);
        simulator.send(1, particles);
        session.cancel_upload(simulator.upload);
    }
    Simulator next(session, {});
    gate.release(2);
    next.send(5, particles);
    next.end();
    EXPECT_EQ(next.receive_story(), (Story{"5"}));
    EXPECT_EQ(begun, 2);
}

TEST_F(Policies, ADrainedStreamIsToldAndGetsItsAnswersBeforeTheEnd) {
    Simulator simulator(session, {});
    simulator.send(0, particles);
    wait_for_begun(1);
    session.drain(std::chrono::seconds(7));
    gate.release();
    simulator.end();
    EXPECT_EQ(simulator.receive_story(), (Story{"draining", "0"}));
}

}  // namespace
}  // namespace meniscus::server::test
