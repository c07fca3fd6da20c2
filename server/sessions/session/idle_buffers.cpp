#include "sessions/session/idle_buffers.hpp"

#include <algorithm>

#include "sessions/session/session.hpp"

namespace meniscus::server {

void IdleBuffers::add(const std::weak_ptr<Session>& session) {
    const std::lock_guard lock(mutex_);
    std::erase_if(sessions_, [](const auto& each) { return each.expired(); });
    sessions_.push_back(session);
}

void IdleBuffers::make_room(const std::function<bool()>& is_room) {
    struct Idle {
        std::chrono::steady_clock::time_point since;
        std::shared_ptr<Session> session;
    };
    std::vector<Idle> idle;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& each : sessions_) {
            auto session = each.lock();
            const auto since = session ? session->resting_since() : std::nullopt;
            if (since) idle.push_back({.since = *since, .session = std::move(session)});
        }
    }
    std::ranges::sort(idle, {}, &Idle::since);
    const auto deadline = std::chrono::steady_clock::now() + patience;
    for (const Idle& each : idle) {
        if (is_room()) return;
        each.session->release_buffers().wait_until(deadline);
    }
}

}  // namespace meniscus::server
