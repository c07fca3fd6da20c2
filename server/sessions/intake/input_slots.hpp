// The buffers that a session's frames arrive in.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>

#include "sessions/handover/slot_pool.hpp"
#include "sessions/intake/input_frame.hpp"

namespace meniscus::server {

/// Two slots, and a third for UploadPolicy::latest: for the frame that waits, and is replaced once a newer one is
/// complete. Thread-safe.
class InputSlots {
public:
    /// session: its part of the bytes in flight. memory: counts what the slots keep between two frames; may be none.
    /// pinning: see InputFrame::pin(); may be none.
    InputSlots(const std::shared_ptr<MemoryAccount>& account, const std::shared_ptr<BytesInFlight>& in_flight,
               const std::shared_ptr<SessionInFlight>& session, const std::shared_ptr<SharedMemory>& memory = nullptr,
               const std::shared_ptr<PagePinning>& pinning = nullptr);

    /// Calls the waiter once a slot is free, at once or from the thread that gives one back.
    void request(SlotPool<InputFrame>::Waiter waiter) { free_.request(std::move(waiter)); }
    /// The frame in it is no longer in flight; its bytes stay until another frame takes the slot.
    void give_back(InputFrame& input);
    /// Borrows a slot that was given back, for the frame that is still in it. False if another frame has the slot.
    bool take_back(InputFrame& input);
    /// Frees the memory of the slots that no frame has.
    void release_memory();
    /// Lends nothing any more, and keeps no memory of what is given back.
    void close();

    /// Whether the third slot may be lent. Calls no waiter.
    void allow_third(bool allowed);
    /// Lends the third slot if that is allowed.
    void lend_third();

private:
    InputFrame& third() noexcept { return inputs_.back(); }

    std::array<InputFrame, 3> inputs_;
    SlotPool<InputFrame> free_;
    std::atomic<bool> closed_{false};

    std::mutex mutex_;  ///< for what follows
    bool third_allowed_ = false;
    bool third_in_use_ = false;  ///< lent, or among the free ones
};

}  // namespace meniscus::server
