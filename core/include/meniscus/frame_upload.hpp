// A frame's particles on their way to the GPU, ahead of its reconstruction.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

namespace meniscus {

/// The copies that Reconstructor::send_ahead() has begun; none where it could not begin. The frame's arrays must
/// neither move nor change while it lives: its end waits until they are not read any more.
class FrameUpload {
public:
    /// The backend's side. Thread-safe.
    class Sender {
    public:
        virtual ~Sender() = default;
        /// Waits for the copies of this frame, and forgets it unless it is being reconstructed.
        virtual void withdraw(std::uint64_t number) noexcept = 0;
    };

    FrameUpload() = default;
    FrameUpload(std::shared_ptr<Sender> sender, std::uint64_t number) : sender_(std::move(sender)), number_(number) {}
    ~FrameUpload() {
        if (sender_) sender_->withdraw(number_);
    }
    FrameUpload(FrameUpload&& other) noexcept : sender_(std::move(other.sender_)), number_(other.number_) {}
    FrameUpload& operator=(FrameUpload&& other) noexcept {
        FrameUpload old(std::exchange(sender_, std::move(other.sender_)), std::exchange(number_, other.number_));
        return *this;
    }
    FrameUpload(const FrameUpload&) = delete;
    FrameUpload& operator=(const FrameUpload&) = delete;

    /// Another handle of the same frame: the end of either waits for the copies, and forgets the frame.
    FrameUpload another() const { return {sender_, number_}; }

    /// Whether copies were begun.
    bool has_begun() const noexcept { return sender_ != nullptr; }
    /// For the backend: the frame's number; 0 if another has sent it.
    std::uint64_t number_of(const Sender* sender) const noexcept { return sender_.get() == sender ? number_ : 0; }

private:
    std::shared_ptr<Sender> sender_;
    std::uint64_t number_ = 0;
};

}  // namespace meniscus
