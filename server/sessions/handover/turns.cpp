#include "sessions/handover/turns.hpp"

namespace meniscus::server {

std::optional<Turns::Turn> Turns::wait(const std::stop_token& stop, const std::string& who) {
    std::unique_lock lock(mutex_);
    const std::uint64_t mine = asked_++;
    waiting_.push_back(mine);
    changed_.wait(lock, stop, [&] { return !began_ && waiting_.front() == mine; });
    std::erase(waiting_, mine);
    if (stop.stop_requested()) {
        // The next one may have waited for this one alone.
        lock.unlock();
        changed_.notify_all();
        return std::nullopt;
    }
    began_ = Clock::now();
    holder_ = who;
    return std::optional<Turn>(std::in_place, *this);
}

std::string Turns::holder() {
    const std::lock_guard lock(mutex_);
    return holder_;
}

std::uint64_t Turns::waiting() {
    const std::lock_guard lock(mutex_);
    return waiting_.size();
}

std::chrono::duration<double> Turns::taken() {
    const std::lock_guard lock(mutex_);
    return began_ ? taken_ + (Clock::now() - *began_) : taken_;
}

void Turns::end() {
    {
        const std::lock_guard lock(mutex_);
        taken_ += Clock::now() - *began_;
        began_.reset();
        holder_.clear();
    }
    changed_.notify_all();
}

}  // namespace meniscus::server
