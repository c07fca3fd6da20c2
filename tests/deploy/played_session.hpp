// A simulator and a watcher, each with a connection of its own, that note their frames and the times of these.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "meniscus/client/client.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {

class PlayedSession {
public:
    using Clock = std::chrono::steady_clock;

    explicit PlayedSession(const std::string& address)
        : simulator_(address, {.wait = patient}), viewer_(address), id_(client::new_session_id()) {
        simulator_.create_session(id_, settings());
        stream_.emplace(simulator_.stream(id_, {.receive_meshes = false, .waiting_limit = 3, .reconnect = patient}));
        watcher_.emplace(viewer_.watch(id_, {.reconnect = patient}));
        pushing_ = std::thread([this] { note_errors("push", [this] { push(); }); });
        receiving_ = std::thread([this] { note_errors("stream", [this] { receive(); }); });
        watching_ = std::thread([this] { note_errors("watcher", [this] { watch(); }); });
    }
    ~PlayedSession() { finish(); }
    PlayedSession(const PlayedSession&) = delete;
    PlayedSession& operator=(const PlayedSession&) = delete;

    const std::string& id() const { return id_; }

    /// From now on frames are pushed without waiting for the watcher, which may miss some: several are under way.
    void stop_waiting_for_the_watcher() {
        const std::lock_guard lock(mutex_);
        in_step_ = false;
        changed_.notify_all();
    }

    std::uint64_t pushed() const {
        const std::lock_guard lock(mutex_);
        return pushed_;
    }

    /// Waits until simulator and watcher have this frame or a later one. Returns when that was; none: not for a long
    /// time.
    std::optional<Clock::time_point> when_all_have(std::uint64_t index) {
        std::unique_lock lock(mutex_);
        const auto has = [&](const std::vector<Noted>& frames) {
            return !frames.empty() && frames.back().index >= index;
        };
        const bool all =
            changed_.wait_for(lock, std::chrono::seconds(30), [&] { return has(received_) && has(shown_); });
        if (!all) return std::nullopt;
        return std::max(first_from(received_, index), first_from(shown_, index));
    }

    /// No more frames; returns once all are answered, and the watcher, if it is waited for, has seen them.
    void finish() {
        {
            const std::lock_guard lock(mutex_);
            if (finished_) return;
            finished_ = true;
            changed_.notify_all();
        }
        pushing_.join();
        receiving_.join();
        {
            std::unique_lock lock(mutex_);
            changed_.wait_for(lock, std::chrono::seconds(30), [&] {
                return !in_step_ || pushed_ == 0 || (!shown_.empty() && shown_.back().index + 1 >= pushed_);
            });
        }
        watcher_->cancel();
        watching_.join();
    }

    /// For messages: how far it is, and what went wrong.
    std::string state() const {
        const std::lock_guard lock(mutex_);
        const auto last = [](const std::vector<Noted>& frames) {
            return frames.empty() ? "none" : std::to_string(frames.back().index);
        };
        std::string text = id_ + ": pushed " + std::to_string(pushed_) + ", received to " + last(received_) +
                           ", shown to " + last(shown_);
        for (const std::string& error : errors_) text += "; " + error;
        return text;
    }

    // After finish().
    std::vector<std::uint64_t> received() const { return indices(received_); }
    std::vector<std::uint64_t> shown() const { return indices(shown_); }
    const std::vector<std::string>& errors() const { return errors_; }

private:
    static constexpr std::chrono::milliseconds patient{60'000};
    static constexpr std::chrono::milliseconds tempo{50};

    struct Noted {
        std::uint64_t index;
        Clock::time_point at;
    };

    static std::vector<std::uint64_t> indices(const std::vector<Noted>& frames) {
        std::vector<std::uint64_t> result;
        result.reserve(frames.size());
        for (const Noted& frame : frames) result.push_back(frame.index);
        return result;
    }

    static Clock::time_point first_from(const std::vector<Noted>& frames, std::uint64_t index) {
        for (const Noted& frame : frames)
            if (frame.index >= index) return frame.at;
        return {};
    }

    void note_errors(const std::string& role, const std::function<void()>& work) {
        try {
            work();
        } catch (const std::exception& error) {
            const std::lock_guard lock(mutex_);
            errors_.push_back(role + ": " + error.what());
            in_step_ = false;
            changed_.notify_all();
        }
    }

    void push() {
        for (std::uint64_t i = 0;; ++i) {
            {
                std::unique_lock lock(mutex_);
                changed_.wait(lock, [&] {
                    return finished_ || !in_step_ || i == 0 || (!shown_.empty() && shown_.back().index + 1 >= i);
                });
                if (changed_.wait_for(lock, tempo, [&] { return finished_; })) break;
            }
            stream_->push(wave(3, static_cast<double>(i)).view(), i, 0.0);
            const std::lock_guard lock(mutex_);
            pushed_ = i + 1;
        }
        stream_->finish();
    }

    void receive() {
        while (const auto frame = stream_->next()) note(received_, frame->index);
    }

    void watch() {
        while (const auto frame = watcher_->next()) note(shown_, frame->index);
    }

    void note(std::vector<Noted>& frames, std::uint64_t index) {
        const std::lock_guard lock(mutex_);
        frames.push_back({.index = index, .at = Clock::now()});
        changed_.notify_all();
    }

    client::Client simulator_;
    client::Client viewer_;
    const std::string id_;
    std::optional<client::Stream> stream_;
    std::optional<client::Watcher> watcher_;

    mutable std::mutex mutex_;  ///< guards the members below
    std::condition_variable changed_;
    bool in_step_ = true;
    bool finished_ = false;
    std::uint64_t pushed_ = 0;
    std::vector<Noted> received_;
    std::vector<Noted> shown_;
    std::vector<std::string> errors_;

    std::thread pushing_;
    std::thread receiving_;
    std::thread watching_;
};

}  // namespace meniscus::server::test
