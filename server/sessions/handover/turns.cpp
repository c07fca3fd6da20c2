#include "sessions/handover/turns.hpp"

#include <algorithm>
#include <iterator>

namespace meniscus::server {

std::optional<Turns::Turn> Turns::wait(const std::stop_token& stop, const std::string& name, const std::string& session,
                                       Needs needs) {
    std::unique_lock lock(mutex_);
    const std::uint64_t mine = asked_++;
    const Lines::iterator line = line_of(name);
    const Clock::time_point since = Clock::now();
    line->waiting.push_back({.number = mine, .needs = needs, .since = since});
    const auto is_next = [&] { return next() == mine; };
    while (!stop.stop_requested() && !(is_next() && is_over(since))) {
        // Only the next one looks at the clock.
        if (longest_ && is_next())
            changed_.wait_until(lock, stop, over_at(since), [&] { return is_over(since); });
        else
            changed_.wait(lock, stop, [&] { return is_next() && (longest_ || is_over(since)); });
    }
    const auto ask_no_more = [&] {
        std::erase_if(line->waiting, [&](const Asked& asked) { return asked.number == mine; });
    };
    if (stop.stop_requested()) {
        ask_no_more();
        const bool has_the_turn = began_ && line == std::prev(lines_.end());
        if (line->waiting.empty() && !has_the_turn) lines_.erase(line);
        // The next one may have waited for this one alone.
        lock.unlock();
        changed_.notify_all();
        return std::nullopt;
    }
    if (began_) end_present();
    ask_no_more();
    lines_.splice(lines_.end(), lines_, line);
    began_ = Clock::now();
    holder_ = session;
    const std::uint64_t number = ++number_;
    under_way_.emplace(number, name);
    if (leader_ == 0) leader_ = number;
    const bool leads = leader_ == number;
    lock.unlock();
    // Whoever is next now waits for the end of this one.
    if (longest_) changed_.notify_all();
    return std::optional<Turn>(std::in_place, *this, number, leads);
}

Turns::Lines::iterator Turns::line_of(const std::string& name) {
    const auto found = std::ranges::find(lines_, name, &Line::name);
    if (found != lines_.end()) return found;
    // A name that has the turn comes after all that have come meanwhile.
    return lines_.insert(began_ ? std::prev(lines_.end()) : lines_.end(), Line{.name = name});
}

std::optional<std::uint64_t> Turns::next() const {
    for (const Line& line : lines_) {
        const auto is_its = [&](const auto& turn) { return turn.second == line.name; };
        if (std::ranges::any_of(under_way_, is_its)) continue;
        for (const Asked& asked : line.waiting)
            if (asked.needs == Needs::any_turn || leader_ == 0) return asked.number;
    }
    return std::nullopt;
}

Turns::Clock::time_point Turns::over_at(Clock::time_point waits_since) const {
    return std::min(*began_ + *longest_, std::max(*began_ + *longest_ / 32, waits_since + *longest_));
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

void Turns::end(std::uint64_t number) {
    {
        const std::lock_guard lock(mutex_);
        // Otherwise it was over, and another one has begun.
        if (number == number_) end_present();
        if (number == leader_) leader_ = 0;
        under_way_.erase(number);
    }
    changed_.notify_all();
}

void Turns::end_present() {
    taken_ += Clock::now() - *began_;
    began_.reset();
    holder_.clear();
    if (lines_.back().waiting.empty()) lines_.pop_back();
}

}  // namespace meniscus::server
