// Frames that are sent to a GPU while the frame before is reconstructed there: on a device in software whose streams do
// nothing before they are waited for, so that code that does not wait meets the old bytes of the area.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "cuda_runtime.h"
#include "host_copies.hpp"
#include "meniscus/meniscus.hpp"
#include "pipeline/backend.hpp"
#include "support/overlap.hpp"
#include "support/particles.hpp"
#include "support/same_bytes.hpp"

namespace meniscus {
namespace {

/// Particles in pinned memory, and the CPU's mesh of them.
struct Frame {
    explicit Frame(unsigned seed, int side = 6, float stretch = 1.0F)
        : particles(test::splash(seed, side)), pinning(cuda::page_pinning(0)) {
        for (float& coordinate : particles.positions) coordinate *= stretch;
        expected = test::reconstruct(test::default_settings(), particles.frame());
        pinning->pin(particles.positions.data(), bytes());
    }
    ~Frame() { pinning->unpin(particles.positions.data()); }
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;

    std::size_t bytes() const { return particles.positions.size() * sizeof(float); }
    ParticleFrame view(const FrameUpload* sent = nullptr) const {
        ParticleFrame frame = particles.frame();
        frame.sent = sent;
        return frame;
    }

    test::Particles particles;
    std::shared_ptr<PagePinning> pinning;
    Mesh expected;
};

class UploadAreas : public testing::Test {
protected:
    ~UploadAreas() override {
        emulated_device::on_copy = nullptr;
        emulated_device::before_copy_to_host = nullptr;
    }

    void make_device(std::size_t limit = 0, std::shared_ptr<const StopFlag> stop = nullptr) {
        device_account = std::make_shared<MemoryAccount>(limit, "on the GPU");
        device = cuda::make_reconstruction(test::default_settings(), BackendOptions{.stop = std::move(stop)}, account,
                                           device_account);
    }
    FrameUpload send(const Frame& frame) const {
        auto sender = device->sender();
        const std::uint64_t number = sender->send(frame.view());
        return number != 0 ? FrameUpload(std::move(sender), number) : FrameUpload();
    }
    /// Returns the number of bytes of its particles that were asked for meanwhile.
    std::size_t reconstruct(const Frame& frame, const FrameUpload* sent = nullptr) {
        std::size_t copied = 0;
        emulated_device::on_copy = [&](const void*, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
            if (kind == cudaMemcpyHostToDevice && test::overlaps(frame.particles.positions, from, bytes))
                copied += bytes;
            return cudaSuccess;
        };
        Statistics statistics;
        Mesh mesh;
        device->reconstruct(frame.view(sent), mesh, statistics).finish();
        emulated_device::on_copy = nullptr;
        EXPECT_TRUE(test::same_bytes(mesh.vertices, frame.expected.vertices));
        EXPECT_TRUE(test::same_bytes(mesh.normals, frame.expected.normals));
        EXPECT_TRUE(test::same_bytes(mesh.triangles, frame.expected.triangles));
        return copied;
    }
    /// The same, while the frame that follows is sent: once the kernels have been asked for.
    FrameUpload reconstruct_and_send(const Frame& frame, const FrameUpload* sent, const Frame& next) {
        FrameUpload ahead;
        bool asked = false;
        emulated_device::before_copy_to_host = [&] {
            // By another thread, as this one may be capturing a graph.
            if (!asked) std::thread([&] { ahead = send(next); }).join();
            asked = true;
            return cudaSuccess;
        };
        reconstruct(frame, sent);
        emulated_device::before_copy_to_host = nullptr;
        return ahead;
    }
    /// Makes two areas exist for frames of this size.
    void make_two_areas(const Frame& frame) {
        EXPECT_FALSE(send(frame).has_begun()) << "there is no area yet";
        reconstruct(frame);
    }

    const std::shared_ptr<MemoryAccount> account = std::make_shared<MemoryAccount>();
    std::shared_ptr<MemoryAccount> device_account;
    std::unique_ptr<BackendReconstruction> device;
};

TEST_F(UploadAreas, EachFrameIsSentWhileTheOneBeforeIsWorkedAt) {
    make_device();
    const std::array<Frame, 2> frames{Frame(1), Frame(2)};
    make_two_areas(frames[0]);
    FrameUpload sent;
    for (std::size_t i = 0; i < 6; ++i) {
        FrameUpload next = reconstruct_and_send(frames.at(i % 2), &sent, frames.at((i + 1) % 2));
        EXPECT_TRUE(next.has_begun()) << i;
        sent = std::move(next);
    }
    const std::uint64_t allocations = device_account->allocations();
    EXPECT_EQ(reconstruct(frames[0], &sent), 0U) << "it is there already";
    EXPECT_EQ(reconstruct(frames[0], &sent), frames[0].bytes()) << "the area may have another frame by now";
    EXPECT_EQ(device_account->allocations(), allocations);
}

TEST_F(UploadAreas, AFrameThatNeedsMoreRoomIsNotSentAgain) {
    make_device();
    const Frame close(1), wide(1, 6, 3.0F);
    make_two_areas(close);
    const FrameUpload sent = send(wide);
    ASSERT_TRUE(sent.has_begun());
    const std::uint64_t allocations = device_account->allocations();
    EXPECT_EQ(reconstruct(wide, &sent), 0U);
    EXPECT_GT(device_account->allocations(), allocations) << "it was to run more than once";
}

TEST_F(UploadAreas, AFrameThatIsGivenUpIsNotReadAnyMoreAndLeavesItsAreaToTheNext) {
    make_device();
    Frame first(1);
    const Frame second(2);
    make_two_areas(first);
    for (int round = 0; round < 3; ++round) {
        FrameUpload sent = send(first);
        EXPECT_TRUE(sent.has_begun());
        EXPECT_FALSE(send(second).has_begun()) << "one at a time";
        sent = {};
        EXPECT_EQ(reconstruct(second), second.bytes());
    }
}

TEST_F(UploadAreas, AFrameBetweenLeavesTheOneThatWasSentWhereItIs) {
    make_device();
    const Frame first(1), second(2);
    make_two_areas(first);
    const FrameUpload sent = send(second);
    EXPECT_EQ(reconstruct(first), first.bytes());
    EXPECT_EQ(reconstruct(first), first.bytes());
    EXPECT_EQ(reconstruct(second, &sent), 0U);
}

TEST_F(UploadAreas, OtherArraysThanWereSentAndOtherReconstructionsFramesAreCopied) {
    make_device();
    const Frame first(1), second(2);
    make_two_areas(first);
    const FrameUpload sent = send(first);
    ASSERT_TRUE(sent.has_begun());
    EXPECT_EQ(reconstruct(second, &sent), second.bytes());
    const auto other = std::move(device);
    make_device();
    make_two_areas(first);
    EXPECT_EQ(reconstruct(first, &sent), first.bytes());
}

TEST_F(UploadAreas, MemoryThatIsNotPinnedIsNotSentAndALargerFrameNotBeforeItsSizeWasMet) {
    make_device();
    const Frame small(1);
    Frame large(2, 9);
    make_two_areas(small);
    EXPECT_FALSE(send(large).has_begun());
    EXPECT_EQ(reconstruct(large), large.bytes());
    EXPECT_TRUE(send(large).has_begun());
    large.pinning->unpin(large.particles.positions.data());
    EXPECT_FALSE(send(large).has_begun());
}

TEST_F(UploadAreas, FramesThatCannotBeSentTakeNoSecondArea) {
    Frame frame(1);
    frame.pinning->unpin(frame.particles.positions.data());
    make_device();
    reconstruct(frame);
    const std::size_t with_one = device_account->bytes();
    make_device();
    EXPECT_FALSE(send(frame).has_begun());
    reconstruct(frame);
    EXPECT_EQ(device_account->bytes(), with_one);
}

TEST_F(UploadAreas, WhereTheLimitLeavesNoSecondAreaFramesAreSentIfNoneIsWorkedAt) {
    const Frame first(1), second(2, 9);
    make_device();
    reconstruct(first);
    reconstruct(second);
    const std::size_t enough = device_account->peak_bytes();
    make_device(enough);
    for (const Frame* frame : {&first, &second, &first, &second, &second}) {
        const FrameUpload sent = send(*frame);
        const FrameUpload next = reconstruct_and_send(*frame, &sent, second);
        EXPECT_LE(device_account->peak_bytes(), enough);
    }
}

TEST_F(UploadAreas, ACopyThatFailsFailsNoFrame) {
    make_device();
    const Frame first(1), second(2);
    make_two_areas(first);
    emulated_device::on_copy = [](const void*, const void*, std::size_t, cudaMemcpyKind) {
        return cudaErrorLaunchFailure;
    };
    EXPECT_FALSE(send(second).has_begun());
    emulated_device::on_copy = nullptr;
    EXPECT_EQ(reconstruct(second), second.bytes());
    EXPECT_TRUE(send(second).has_begun());
}

TEST_F(UploadAreas, AFrameThatIsStoppedLeavesTheNextOneSent) {
    const auto stop = std::make_shared<StopFlag>();
    make_device(0, stop);
    const Frame first(1), second(2);
    make_two_areas(first);
    const FrameUpload sent_first = send(first);
    stop->raise();
    EXPECT_THROW(reconstruct(first, &sent_first), Stopped);
    stop->lower();
    const FrameUpload sent = send(second);
    EXPECT_TRUE(sent.has_begun());
    EXPECT_EQ(reconstruct(first), first.bytes());
    EXPECT_EQ(reconstruct(second, &sent), 0U);
}

TEST_F(UploadAreas, AReconstructionThatEndsTakesWhatWasSentWithIt) {
    make_device();
    const Frame frame(1);
    make_two_areas(frame);
    const auto sender = device->sender();
    const FrameUpload sent = send(frame);
    EXPECT_TRUE(sent.has_begun());
    device.reset();
    EXPECT_EQ(device_account->bytes(), 0U);
    EXPECT_EQ(sender->send(frame.view()), 0U);
}

TEST_F(UploadAreas, OneThreadSendsWhatAnotherReconstructs) {
    make_device();
    const std::array<Frame, 3> frames{Frame(1), Frame(2), Frame(3)};
    make_two_areas(frames[0]);
    FrameUpload sent;
    for (std::size_t i = 0; i < 9; ++i) {
        FrameUpload next;
        std::thread sender([&] { next = send(frames.at((i + 1) % 3)); });
        Statistics statistics;
        Mesh mesh;
        device->reconstruct(frames.at(i % 3).view(&sent), mesh, statistics).finish();
        sender.join();
        EXPECT_TRUE(test::same_bytes(mesh.triangles, frames.at(i % 3).expected.triangles));
        EXPECT_TRUE(test::same_bytes(mesh.vertices, frames.at(i % 3).expected.vertices));
        sent = std::move(next);
    }
}

}  // namespace
}  // namespace meniscus
