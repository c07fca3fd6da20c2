// Which of the sessions that an id has named are one's own.
#pragma once

#include <algorithm>
#include <chrono>
#include <mutex>
#include <vector>

#include "meniscus/v1/session_service.pb.h"
#include "session_calls.hpp"

namespace meniscus::client {

/// The sessions of one id that this process has made, known by the time of their creation: where one has ended, another
/// client may have created the next one. Thread-safe: a Session and its streams create them.
class MadeSessions {
public:
    void note(const v1::CreateSessionResponse& response) {
        if (!response.created()) return;
        const std::lock_guard lock(mutex_);
        created_at_.push_back(time_from_wire(response.session().created_at()));
    }
    bool has(std::chrono::system_clock::time_point created_at) const {
        const std::lock_guard lock(mutex_);
        return std::ranges::find(created_at_, created_at) != created_at_.end();
    }

private:
    mutable std::mutex mutex_;
    std::vector<std::chrono::system_clock::time_point> created_at_;
};

}  // namespace meniscus::client
