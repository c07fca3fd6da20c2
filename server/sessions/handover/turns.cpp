#include "sessions/handover/turns.hpp"

namespace meniscus::server {

Turns::Turn Turns::wait() {
    std::unique_lock lock(mutex_);
    const std::uint64_t mine = asked_++;
    ended_.wait(lock, [&] { return current_ == mine; });
    began_ = Clock::now();
    return Turn(*this);
}

std::uint64_t Turns::waiting() {
    const std::lock_guard lock(mutex_);
    return asked_ > current_ ? asked_ - current_ - 1 : 0;
}

std::chrono::duration<double> Turns::taken() {
    const std::lock_guard lock(mutex_);
    return began_ ? taken_ + (Clock::now() - *began_) : taken_;
}

void Turns::end() {
    {
        const std::lock_guard lock(mutex_);
        ++current_;
        taken_ += Clock::now() - *began_;
        began_.reset();
    }
    ended_.notify_all();
}

}  // namespace meniscus::server
