#include "sessions/limits/bytes_in_flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "sessions/limits/limit_reached.hpp"

namespace meniscus::server {

BytesInFlight::BytesInFlight(std::size_t limit, std::uint32_t sessions, std::function<Clock::time_point()> now)
    : now_(std::move(now)),
      limit_(limit),
      share_(sessions != 0 ? limit / 4 / sessions : 0),
      common_(limit - share_ * sessions) {}

std::size_t BytesInFlight::waiting() const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(
        std::ranges::count_if(frames_, [](const FrameInFlight* frame) { return frame->waits(); }));
}

bool BytesInFlight::others_wait(const SessionInFlight& session) const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(
        frames_, [&](const FrameInFlight* frame) { return frame->waits() && frame->session_.get() != &session; });
}

void BytesInFlight::look_again() {
    Calls calls;
    {
        const std::lock_guard lock(mutex_);
        calls = grant_waiting();
    }
    for (const auto& call : calls) call();
}

bool BytesInFlight::name_has_room(const FrameInFlight& frame) const {
    const NameInFlight* const name = frame.session_->name.get();
    const std::size_t name_limit = name != nullptr ? name->limit.load() : 0;
    return name_limit == 0 || name->announced == 0 ||
           (name->announced <= name_limit && frame.announced_ <= name_limit - name->announced);
}

bool BytesInFlight::is_oversized(const FrameInFlight& frame) const {
    return frame.announced_ > common_ + share_;
}

std::size_t BytesInFlight::own_part(const FrameInFlight& frame) const {
    if (frame.admitted_) return frame.own_;
    return is_oversized(frame) ? 0 : std::min(frame.announced_, share_ - std::min(share_, frame.session_->booked));
}

FrameInFlight* BytesInFlight::next() const {
    const auto now = now_();
    const auto found = std::ranges::find_if(frames_, [&](const FrameInFlight* frame) {
        return frame->missing() != 0 && frame->is_due(now) && (frame->admitted_ || name_has_room(*frame)) &&
               fits_beside_slow(*frame);
    });
    return found != frames_.end() ? *found : nullptr;
}

bool BytesInFlight::fits_beside(const FrameInFlight& next, const FrameInFlight& frame) const {
    std::size_t bytes = frame.announced_;
    std::size_t beyond = frame.announced_ - own_part(frame);
    // What it takes from nobody.
    if (beyond == 0 && !is_oversized(next)) return true;
    for (const FrameInFlight* each : frames_) {
        if (!each->admitted_ && each != &next) continue;
        bytes += each->announced_;
        beyond += each->announced_ - own_part(*each);
    }
    return have_room(bytes, beyond, is_oversized(next));
}

bool BytesInFlight::fits_beside_slow(const FrameInFlight& frame) const {
    const auto now = now_();
    std::size_t bytes = frame.announced_;
    std::size_t beyond = frame.announced_ - own_part(frame);
    for (const FrameInFlight* each : frames_) {
        if (each == &frame || !each->admitted_ || each->arrived_ == each->announced_ || !each->is_slow(now)) continue;
        if (each->admitted_at_ >= frame.due_since()) continue;
        bytes += each->announced_;
        beyond += each->announced_ - each->own_;
    }
    return have_room(bytes, beyond, is_oversized(frame));
}

bool BytesInFlight::have_room(std::size_t bytes, std::size_t beyond, bool oversized) const {
    return oversized ? bytes <= limit_ : beyond <= common_;
}

bool BytesInFlight::admit(FrameInFlight& frame) {
    if (!name_has_room(frame)) return false;
    NameInFlight* const name = frame.session_->name.get();
    std::size_t own = frame.announced_;
    if (limit_ != 0) {
        frame.oversized_ = is_oversized(frame);
        own = own_part(frame);
        if (own > limit_ - booked_) return false;
        const FrameInFlight* const first = next();
        if (first != nullptr && first != &frame && !fits_beside(*first, frame)) return false;
        // A frame that fits into its share is never in anybody's way.
        frame.own_ = own;
        frame.admitted_ = true;
        if (own < frame.announced_ && !is_safe(frame, 0)) {
            frame.own_ = 0;
            frame.admitted_ = false;
            return false;
        }
    }
    frame.own_ = own;
    frame.admitted_ = true;
    frame.admitted_at_ = now_();
    frame.session_->booked += own;
    booked_ += own;
    if (name != nullptr) name->announced += frame.announced_;
    return true;
}

bool BytesInFlight::grant(FrameInFlight& frame) {
    if (!frame.admitted_ && !admit(frame)) return false;
    const std::size_t booked = frame.own_ + frame.taken_;
    if (frame.arrived_ <= booked) return true;
    const std::size_t more = frame.arrived_ - booked;
    if (more > limit_ - booked_) return false;
    if (!frame.oversized_ && (taken_ > common_ || more > common_ - taken_)) return false;
    if (!is_safe(frame, more)) return false;
    frame.taken_ += more;
    taken_ += more;
    booked_ += more;
    return true;
}

bool BytesInFlight::is_safe(const FrameInFlight& frame, std::size_t more) const {
    struct Claim {
        std::size_t missing;
        std::size_t taken;
    };
    std::vector<Claim> claims;
    std::vector<Claim> oversized;
    std::size_t taken = 0;
    std::size_t taken_by_oversized = 0;
    for (const FrameInFlight* each : frames_) {
        const std::size_t extra = each == &frame ? more : 0;
        // One that has arrived whole is reconstructed, and gives its bytes back.
        if (!each->admitted_ || each->missing() == extra) continue;
        const Claim claim{.missing = each->missing() - extra, .taken = each->taken_ + extra};
        (each->oversized_ ? oversized : claims).push_back(claim);
        taken += claim.taken;
        if (each->oversized_) taken_by_oversized += claim.taken;
    }
    const auto all_arrive = [](std::vector<Claim>& waiting, std::size_t free) {
        std::ranges::sort(waiting, {}, &Claim::missing);
        return std::ranges::all_of(waiting, [&free](const Claim& claim) {
            const bool arrives = claim.missing <= free;
            free += claim.taken;
            return arrives;
        });
    };
    // First those that leave the shares alone; the oversized ones may have the rest once these are gone.
    return all_arrive(claims, common_ - std::min(common_, taken)) && taken_by_oversized <= limit_ &&
           all_arrive(oversized, limit_ - taken_by_oversized);
}

void BytesInFlight::forget(FrameInFlight& frame) {
    if (!std::exchange(frame.begun_, false)) return;
    std::erase(frames_, &frame);
    if (frame.admitted_) {
        frame.session_->booked -= frame.own_;
        if (frame.session_->name) frame.session_->name->announced -= frame.announced_;
        taken_ -= frame.taken_;
        booked_ -= frame.own_ + frame.taken_;
    }
    frame.admitted_ = frame.oversized_ = false;
    frame.announced_ = frame.arrived_ = frame.own_ = frame.taken_ = 0;
    frame.waited_ = frame.sending_ = {};
}

BytesInFlight::Calls BytesInFlight::grant_waiting() {
    Calls calls;
    const auto try_to_book = [&](FrameInFlight& frame) {
        if (frame.waits() && grant(frame)) std::ranges::move(frame.end_to_wait(now_()), std::back_inserter(calls));
    };
    if (FrameInFlight* const first = next()) try_to_book(*first);
    for (FrameInFlight* frame : frames_) try_to_book(*frame);
    return calls;
}

void FrameInFlight::begin_to_wait(std::function<void()> waiter, Clock::time_point now) {
    const bool waited_already = waits();
    waiters_.push_back(std::move(waiter));
    if (waited_already) return;
    sending_ += now - std::exchange(since_, now);
    if (waited_ >= BytesInFlight::patience && sending_ >= BytesInFlight::patience) waited_ = {};  // it was next
}

std::vector<std::function<void()>> FrameInFlight::end_to_wait(Clock::time_point now) {
    const bool was_due = waited_ >= BytesInFlight::patience;
    const Clock::time_point due = due_since();
    waited_ += now - std::exchange(since_, now);
    if (!was_due && waited_ >= BytesInFlight::patience) {
        due_since_ = due;
        sending_ = {};
    }
    return std::exchange(waiters_, {});
}

bool FrameInFlight::is_due(Clock::time_point now) const {
    const auto passed = now - since_;
    return waits() ? waited_ + passed >= BytesInFlight::patience
                   : waited_ >= BytesInFlight::patience && sending_ + passed < BytesInFlight::patience;
}

FrameInFlight::Clock::time_point FrameInFlight::due_since() const {
    return waited_ >= BytesInFlight::patience ? due_since_ : since_ + (BytesInFlight::patience - waited_);
}

bool FrameInFlight::is_slow(Clock::time_point now) const {
    return !is_due(now) && sending_ + (waits() ? Clock::duration{} : now - since_) >= BytesInFlight::patience;
}

FrameInFlight::FrameInFlight(FrameInFlight&& other) noexcept : all_(other.all_), session_(other.session_) {
    const std::lock_guard lock(all_->mutex_);
    begun_ = std::exchange(other.begun_, false);
    admitted_ = std::exchange(other.admitted_, false);
    oversized_ = std::exchange(other.oversized_, false);
    announced_ = std::exchange(other.announced_, 0);
    arrived_ = std::exchange(other.arrived_, 0);
    own_ = std::exchange(other.own_, 0);
    taken_ = std::exchange(other.taken_, 0);
    waiters_ = std::exchange(other.waiters_, {});
    waited_ = std::exchange(other.waited_, {});
    sending_ = std::exchange(other.sending_, {});
    since_ = other.since_;
    admitted_at_ = other.admitted_at_;
    due_since_ = other.due_since_;
    std::ranges::replace(all_->frames_, &other, this);
}

void FrameInFlight::announce(std::size_t bytes) {
    release();
    const std::size_t limit = all_->limit_;
    if (limit != 0 && bytes > limit)
        throw LimitReached(
            LimitName::bytes_in_flight,
            fmt::format(
                "a frame of {} bytes; the server takes at most {} bytes over all sessions: send fewer particles", bytes,
                limit));
    const std::size_t name_limit = session_->name ? session_->name->limit.load() : 0;
    if (name_limit != 0 && bytes > name_limit)
        throw LimitReached(
            LimitName::bytes_in_flight_per_name,
            fmt::format(
                "a frame of {} bytes; the server takes at most {} bytes at a time of one caller: send fewer particles",
                bytes, name_limit));
    const std::lock_guard lock(all_->mutex_);
    announced_ = bytes;
    begun_ = true;
    since_ = all_->now_();
    all_->frames_.push_back(this);
    all_->grant(*this);
}

bool FrameInFlight::book(std::size_t arrived, std::function<void()> booked) {
    BytesInFlight::Calls calls;
    {
        const std::lock_guard lock(all_->mutex_);
        if (!begun_) return true;
        arrived_ = std::max(arrived_, arrived);
        const bool was_missing = missing() != 0;
        if (!all_->grant(*this)) {
            begin_to_wait(std::move(booked), all_->now_());
            return false;
        }
        if (waits()) calls = end_to_wait(all_->now_());
        // It may have been the next one, and kept others from beginning.
        if (was_missing && missing() == 0) std::ranges::move(all_->grant_waiting(), std::back_inserter(calls));
    }
    for (const auto& call : calls) call();
    return true;
}

void FrameInFlight::release() noexcept {
    BytesInFlight::Calls calls;
    std::vector<std::function<void()>> forgotten;  // destroyed outside of the lock
    {
        const std::lock_guard lock(all_->mutex_);
        if (!begun_) return;
        forgotten = std::exchange(waiters_, {});
        all_->forget(*this);
        calls = all_->grant_waiting();
    }
    for (const auto& call : calls) call();
}

}  // namespace meniscus::server
