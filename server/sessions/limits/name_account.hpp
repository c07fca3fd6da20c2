// The accounts of callers: the share that each has of the server.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "sessions/limits/bytes_in_flight.hpp"
#include "sessions/limits/frame_rate.hpp"
#include "sessions/limits/name_shares.hpp"

namespace meniscus::server {

/// One caller's account. Thread-safe.
class NameAccount {
public:
    explicit NameAccount(std::string name) : name_(std::move(name)) {}

    /// A token's name or a peer's address.
    const std::string& name() const noexcept { return name_; }
    NameShares shares() const {
        const std::lock_guard lock(mutex_);
        return shares_;
    }
    void set_shares(const NameShares& shares) {
        const std::lock_guard lock(mutex_);
        if (shares.frames_per_second != shares_.frames_per_second) frame_rate_ = FrameRate(shares.frames_per_second);
        shares_ = shares;
        in_flight_->limit = shares.bytes_in_flight;
    }
    /// Returns whether one more frame may begin now; if so, counts it.
    bool take_frame(FrameRate::Clock::time_point now) {
        const std::lock_guard lock(mutex_);
        return frame_rate_.take(now);
    }
    /// Returns whether it may begin as many frames as one that is new.
    bool rested(FrameRate::Clock::time_point now) const {
        const std::lock_guard lock(mutex_);
        return frame_rate_.full(now);
    }
    const std::shared_ptr<NameInFlight>& in_flight() const noexcept { return in_flight_; }

    std::atomic<std::uint32_t> ending{0};     ///< sessions that were removed, and whose threads may run still
    std::atomic<std::uint32_t> snapshots{0};  ///< under way

private:
    const std::string name_;
    const std::shared_ptr<NameInFlight> in_flight_ = std::make_shared<NameInFlight>();
    mutable std::mutex mutex_;  ///< for what follows
    NameShares shares_;
    FrameRate frame_rate_{0};
};

/// Kept for as long as somebody holds one (a session, a watcher), and then until it is rested, at most a second: a
/// caller that deletes its sessions has no more frames by it. Thread-safe.
class NameAccounts {
public:
    /// shares: those of the account from now on.
    std::shared_ptr<NameAccount> of(const std::string& name, const NameShares& shares,
                                    FrameRate::Clock::time_point now = FrameRate::Clock::now()) {
        const std::lock_guard lock(mutex_);
        // Only here are references made of the one in the map: the last one stays the last.
        std::erase_if(accounts_,
                      [&](const auto& entry) { return entry.second.use_count() == 1 && entry.second->rested(now); });
        auto& account = accounts_[name];
        if (!account) account = std::make_shared<NameAccount>(name);
        account->set_shares(shares);
        return account;
    }

private:
    std::mutex mutex_;
    std::map<std::string, std::shared_ptr<NameAccount>> accounts_;
};

}  // namespace meniscus::server
