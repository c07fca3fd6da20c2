#include "sessions/session_registry.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "meniscus/error.hpp"
#include "sessions/refusal.hpp"

namespace meniscus::server {

SessionRegistry::SessionRegistry(const Limits& limits, const BackendOptions& backend, unsigned encoding_threads)
    : limits_(limits), backend_(backend), workers_(std::make_shared<WorkerPool>(encoding_threads)) {
    joining_ = std::thread([this] {
        while (const auto session = removed_.take()) (*session)->join();
    });
}

SessionRegistry::~SessionRegistry() {
    removed_.close();
    joining_.join();
    for (const auto& [id, session] : sessions_) session->close();
}

std::shared_ptr<Session> SessionRegistry::create(const std::string& id, const Settings& settings) {
    const std::lock_guard lock(mutex_);
    if (draining_) throw Refusal(Refusal::Kind::unavailable, "the server is shutting down");
    if (const auto found = sessions_.find(id); found != sessions_.end()) {
        if (found->second->settings() == settings) return found->second;
        throw Refusal(Refusal::Kind::already_exists, fmt::format("session {} exists with other settings", id));
    }
    if (limits_.sessions != 0 && sessions_.size() >= limits_.sessions)
        throw LimitExceeded(
            fmt::format("{} sessions are open; the server holds at most {}", sessions_.size(), limits_.sessions));
    auto session = std::make_shared<Session>(id, settings, limits_, backend_, workers_);
    sessions_.emplace(id, session);
    spdlog::info("session {} created ({} open)", id, sessions_.size());
    return session;
}

std::shared_ptr<Session> SessionRegistry::find(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    const auto found = sessions_.find(id);
    if (found == sessions_.end()) throw Refusal(Refusal::Kind::not_found, fmt::format("no session {}", id));
    return found->second;
}

std::vector<std::shared_ptr<Session>> SessionRegistry::list() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::shared_ptr<Session>> sessions;
    sessions.reserve(sessions_.size());
    for (const auto& [id, session] : sessions_) sessions.push_back(session);
    return sessions;
}

void SessionRegistry::remove(const std::string& id) {
    std::shared_ptr<Session> session;
    std::size_t left = 0;
    {
        const std::lock_guard lock(mutex_);
        const auto found = sessions_.find(id);
        if (found == sessions_.end()) throw Refusal(Refusal::Kind::not_found, fmt::format("no session {}", id));
        session = std::move(found->second);
        sessions_.erase(found);
        left = sessions_.size();
    }
    session->close();
    spdlog::info("session {} deleted ({} open)", id, left);
    removed_.put(std::move(session));
}

void SessionRegistry::drain() {
    {
        const std::lock_guard lock(mutex_);
        draining_ = true;
    }
    for (const auto& session : list()) session->drain();
}

}  // namespace meniscus::server
