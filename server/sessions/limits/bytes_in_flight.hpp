// The bytes of all sessions' frames that are on their way to be reconstructed: which frame may have how many of them.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace meniscus::server {

class FrameInFlight;

/// A caller's part of the bytes in flight, over all of its sessions. Its numbers belong to BytesInFlight.
struct NameInFlight {
    std::atomic<std::size_t> limit{0};  ///< bytes of frames, as announced; 0: none of its own
    std::size_t announced = 0;
};

/// A session's part of the bytes in flight. Its numbers belong to BytesInFlight.
struct SessionInFlight {
    std::size_t booked = 0;                        ///< of its share
    std::shared_ptr<NameInFlight> name = nullptr;  ///< none: the session counts for nobody
};

/// Gives the bytes out. Every session has a share, which is kept for it: a quarter of the limit is divided among the
/// sessions that there may be. A frame's bytes are booked
/// * from its session's share as the frame is announced, as far as the share reaches;
/// * beyond the share from what all sessions have in common, as they arrive, so that an announcement costs nobody
///   anything. A frame waits there for those that have come before it; it is never refused once it has begun.
///
/// A frame gets bytes only while there is an order in which all frames that have begun can still arrive whole (the
/// banker's algorithm with one resource, for which the order by what is missing is as good as any): two large frames
/// can never wait for each other. A frame of more than what is in common, and its session's share, is oversized: it
/// takes nothing from its share, and the last part of it also what the others have not booked of theirs.
///
/// So that small frames do not keep out a large one for ever, a frame that has waited for a second is next, the oldest
/// of them first: until all its bytes are booked, no other frame begins but one for which there is room beside it and
/// all that have begun. That cannot stop the frames that have begun, which come in by the order above, and once they
/// are gone nothing is in the way of the next one. Whoever sends slowly gains nothing by it: a frame whose own bytes
/// are on their way for a second is next no more, until it has waited for another second; and one for which there is no
/// room beside such slow ones is not next before they are gone. Slow ones that have begun since it was due do not count
/// there: with them, slow frames in turn would keep out a large one for ever.
///
/// Thread-safe.
class BytesInFlight {
public:
    using Clock = std::chrono::steady_clock;

    /// After which a frame is next, and for which it may be so while its own bytes are on their way.
    static constexpr std::chrono::seconds patience{1};

    /// limit: bytes, 0 for none. sessions: as many have a share; 0: none has one, as there may be any number. now: the
    /// clock, called with the lock held.
    explicit BytesInFlight(std::size_t limit = 0, std::uint32_t sessions = 0,
                           std::function<Clock::time_point()> now = Clock::now);

    /// Booked by now.
    std::size_t bytes() const noexcept { return booked_.load(std::memory_order_relaxed); }
    std::size_t limit() const noexcept { return limit_; }
    /// Bytes that are kept for each session.
    std::size_t share() const noexcept { return share_; }
    /// Frames that wait for bytes.
    std::size_t waiting() const;
    /// Whether frames of other sessions wait for bytes.
    bool others_wait(const SessionInFlight& session) const;
    /// Books for frames that another one has kept from beginning, and does no longer, as time has passed. Call it once
    /// within each patience or so.
    void look_again();

private:
    friend class FrameInFlight;
    using Calls = std::vector<std::function<void()>>;

    // With the lock held.
    bool grant(FrameInFlight& frame);
    bool admit(FrameInFlight& frame);
    bool name_has_room(const FrameInFlight& frame) const;
    bool is_oversized(const FrameInFlight& frame) const;
    /// Of its session's share, which it has or would have if it began now.
    std::size_t own_part(const FrameInFlight& frame) const;
    /// The frame that is next; may be none.
    FrameInFlight* next() const;
    /// Whether the next frame has its room if this one begins, too.
    bool fits_beside(const FrameInFlight& next, const FrameInFlight& frame) const;
    /// Whether a frame that is due has room if those stay that come slowly and have begun before.
    bool fits_beside_slow(const FrameInFlight& frame) const;
    /// Whether there is room for these at once. beyond: their shares. oversized: whether one of them may have the
    /// others' shares.
    bool have_room(std::size_t bytes, std::size_t beyond, bool oversized) const;
    /// Whether all frames that have begun can arrive whole, if this one has `more` bytes.
    bool is_safe(const FrameInFlight& frame, std::size_t more) const;
    void forget(FrameInFlight& frame);
    /// Books for waiting frames. Returns the calls for those whose bytes are booked by now, in their order.
    Calls grant_waiting();

    const std::function<Clock::time_point()> now_;
    const std::size_t limit_;
    const std::size_t share_;   ///< of each session
    const std::size_t common_;  ///< what remains
    std::atomic<std::size_t> booked_{0};

    mutable std::mutex mutex_;            ///< for what follows
    std::vector<FrameInFlight*> frames_;  ///< in the order of their announcements
    std::size_t taken_ = 0;               ///< of what is in common
};

/// One frame's part, until it is released. One thread at a time, but for book(), which several that receive the frame
/// may call.
class FrameInFlight {
public:
    explicit FrameInFlight(std::shared_ptr<BytesInFlight> all,
                           std::shared_ptr<SessionInFlight> session = std::make_shared<SessionInFlight>())
        : all_(std::move(all)), session_(std::move(session)) {}
    ~FrameInFlight() { release(); }
    /// The other one has nothing afterwards.
    FrameInFlight(FrameInFlight&& other) noexcept;
    FrameInFlight(const FrameInFlight&) = delete;
    FrameInFlight& operator=(const FrameInFlight&) = delete;
    FrameInFlight& operator=(FrameInFlight&&) = delete;

    /// Begins a frame of this size; the one before is released. Throws LimitExceeded if there could never be room for
    /// it.
    void announce(std::size_t bytes);
    /// Books this number of the announced bytes, which have arrived. If it returns false, they are booked later, and
    /// the function is called then, by another thread, unless the frame is released before. So are those of others that
    /// wait: all are called together, once what has arrived by then is booked.
    bool book(std::size_t arrived, std::function<void()> booked);
    void release() noexcept;

private:
    friend class BytesInFlight;

    using Clock = BytesInFlight::Clock;

    std::size_t missing() const noexcept { return admitted_ ? announced_ - own_ - taken_ : announced_; }
    void begin_to_wait(std::function<void()> waiter, Clock::time_point now);
    /// Returns the functions to call.
    std::vector<std::function<void()>> end_to_wait(Clock::time_point now);
    bool waits() const noexcept { return !waiters_.empty(); }
    /// Whether it has waited long enough to be next.
    bool is_due(Clock::time_point now) const;
    /// Since when it is due, if it is.
    Clock::time_point due_since() const;
    /// Whether its bytes are on their way for long.
    bool is_slow(Clock::time_point now) const;

    const std::shared_ptr<BytesInFlight> all_;
    const std::shared_ptr<SessionInFlight> session_;

    // The following belong to BytesInFlight, with its lock held.
    bool begun_ = false;
    bool admitted_ = false;
    bool oversized_ = false;
    std::size_t announced_ = 0;
    std::size_t arrived_ = 0;
    std::size_t own_ = 0;    ///< booked from the session's share
    std::size_t taken_ = 0;  ///< and beyond it
    std::vector<std::function<void()>> waiters_;
    Clock::duration waited_{};   ///< for bytes, up to since_
    Clock::duration sending_{};  ///< its simulator, up to since_; from when it was next, once it is
    Clock::time_point since_;    ///< it waits, or does not
    Clock::time_point admitted_at_;
    Clock::time_point due_since_;  ///< of one that has waited for long enough and waits no longer
};

}  // namespace meniscus::server
