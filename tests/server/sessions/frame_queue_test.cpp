#include "sessions/intake/frame_queue.hpp"

#include <gtest/gtest.h>

#include <array>
#include <thread>

namespace meniscus::server {
namespace {

using Next = FrameQueue::Next;

struct Queue : testing::Test {
    Queue() {
        for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i].index = i;
    }
    std::shared_ptr<Upload> upload() const {
        return std::make_shared<Upload>(
            UploadOptions{}, [](std::size_t /*part*/) {}, [] {});
    }

    FrameQueue queue;
    std::array<InputFrame, 3> inputs{InputFrame(nullptr), InputFrame(nullptr), InputFrame(nullptr)};
    std::shared_ptr<Upload> mine = upload();
    std::shared_ptr<Upload> other = upload();
};

TEST_F(Queue, NotesAReplacedFrameInItsPlace) {
    queue.put({.upload = other, .input = &inputs[0]});
    queue.put({.upload = mine, .input = &inputs[1]});
    EXPECT_EQ(queue.replace(*mine), (std::vector<InputFrame*>{&inputs[1]}));
    queue.put({.upload = mine, .input = &inputs[2]});
    EXPECT_EQ(queue.take(Next::frame)->input, &inputs[0]);
    EXPECT_EQ(queue.wait(), Next::note);
    const auto note = queue.take(Next::note);
    EXPECT_EQ(note->dropped->index, 1U);
    EXPECT_EQ(note->dropped->reason, DropReason::replaced);
    EXPECT_EQ(queue.take(Next::frame)->input, &inputs[2]);
}

TEST_F(Queue, ForgetsTheFramesOfOneUploadAndKeepsItsEnd) {
    queue.put({.upload = mine, .input = &inputs[0]});
    queue.put({.upload = other, .input = &inputs[1]});
    queue.put({.upload = mine, .dropped = DroppedFrame{.index = 7}});
    queue.put({.upload = mine});
    EXPECT_EQ(queue.withdraw(*mine), (std::vector<InputFrame*>{&inputs[0]}));
    EXPECT_EQ(queue.take(Next::frame)->upload, other);
    EXPECT_EQ(queue.take(Next::note)->upload, mine);
}

TEST_F(Queue, GivesNothingInPlaceOfAFrameThatWentWhileItsTakerMadeReady) {
    queue.put({.upload = mine, .input = &inputs[0]});
    EXPECT_EQ(queue.wait(), Next::frame);
    queue.replace(*mine);
    EXPECT_FALSE(queue.take(Next::frame));
    EXPECT_EQ(queue.wait(), Next::note);
}

TEST_F(Queue, HasOneNoteOfWatchersHoweverManyCome) {
    for (int i = 0; i < 3; ++i) queue.put({.watchers = true});
    queue.put({.upload = mine, .input = &inputs[0]});
    EXPECT_TRUE(queue.take(Next::note)->watchers);
    EXPECT_EQ(queue.wait(), Next::frame);
    queue.put({.watchers = true});
    EXPECT_TRUE(queue.take(Next::frame));
    EXPECT_TRUE(queue.take(Next::note)->watchers) << "of one that came after the note before was taken";
}

TEST_F(Queue, EndsAWaitWhenClosed) {
    std::thread closing([&] { queue.close(); });
    EXPECT_EQ(queue.wait(), Next::closed);
    closing.join();
    queue.put({.upload = mine, .input = &inputs[0]});
    EXPECT_FALSE(queue.take(Next::frame));
}

}  // namespace
}  // namespace meniscus::server
