#include "sessions/handover/turns.hpp"

#include <algorithm>
#include <iterator>

namespace meniscus::server {

std::optional<Turns::Turn> Turns::wait(const std::stop_token& stop, const std::string& name,
                                       const std::string& session) {
    std::unique_lock lock(mutex_);
    const std::uint64_t mine = asked_++;
    Line& line = line_of(name);
    line.waiting.push_back(mine);
    changed_.wait(lock, stop, [&] { return !began_ && lines_.front().waiting.front() == mine; });
    std::erase(line.waiting, mine);
    if (stop.stop_requested()) {
        const bool has_the_turn = began_ && &line == &lines_.back();
        if (line.waiting.empty() && !has_the_turn) lines_.remove_if([&](const Line& each) { return &each == &line; });
        // The next one may have waited for this one alone.
        lock.unlock();
        changed_.notify_all();
        return std::nullopt;
    }
    began_ = Clock::now();
    holder_ = session;
    lines_.splice(lines_.end(), lines_, lines_.begin());
    return std::optional<Turn>(std::in_place, *this);
}

Turns::Line& Turns::line_of(const std::string& name) {
    const auto found = std::ranges::find(lines_, name, &Line::name);
    if (found != lines_.end()) return *found;
    // A name that has the turn comes after all that have come meanwhile.
    return *lines_.insert(began_ ? std::prev(lines_.end()) : lines_.end(), Line{.name = name});
}

std::string Turns::holder() {
    const std::lock_guard lock(mutex_);
    return holder_;
}

std::uint64_t Turns::waiting() {
    const std::lock_guard lock(mutex_);
    std::uint64_t sum = 0;
    for (const Line& line : lines_) sum += line.waiting.size();
    return sum;
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
        if (lines_.back().waiting.empty()) lines_.pop_back();
    }
    changed_.notify_all();
}

}  // namespace meniscus::server
