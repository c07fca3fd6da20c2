#include "sessions/session_registry.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "meniscus/devices.hpp"
#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"
#include "sessions/placement.hpp"
#include "sessions/refusal.hpp"

namespace meniscus::server {

namespace {

BackendOptions with_memory_limits(BackendOptions backend, const Limits& limits) {
    backend.memory_limit = limits.bytes_per_session;
    backend.device_memory_limit = limits.device_bytes_per_session;
    return backend;
}

std::shared_ptr<Session> make_session(const std::string& id, const Settings& settings, const Limits& limits,
                                      const BackendOptions& backend, const std::shared_ptr<WorkerPool>& workers,
                                      const std::string& owner, const std::shared_ptr<Metrics>& metrics,
                                      std::shared_ptr<SessionObserver> observer) {
    const auto reconstructor = std::make_shared<Reconstructor>(settings, backend);
    const auto reconstruct = [reconstructor](const ParticleFrame& frame, Mesh& mesh) {
        reconstructor->reconstruct(frame, mesh);
        return reconstructor->statistics();
    };
    const auto emit_capped = [reconstructor](int max_level, Mesh& mesh) { reconstructor->emit_capped(max_level, mesh); };
    return std::make_shared<Session>(id, settings, limits, reconstruct, workers, owner, metrics, emit_capped,
                                     std::move(observer));
}

std::string place_name(const BackendOptions& backend) {
    return backend.backend == Backend::cuda ? fmt::format("GPU {}", backend.device) : "the CPU";
}

}  // namespace

SessionRegistry::SessionRegistry(const Limits& limits, const BackendOptions& backend, unsigned encoding_threads,
                                 std::vector<int> devices, std::shared_ptr<Metrics> metrics, Observe observe)
    : limits_(limits),
      backend_(with_memory_limits(backend, limits)),
      devices_(std::move(devices)),
      observe_(std::move(observe)),
      workers_(std::make_shared<WorkerPool>(encoding_threads)),
      metrics_(std::move(metrics)) {
    joining_ = std::thread([this] {
        while (const auto session = removed_.take()) (*session)->join();
    });
}

SessionRegistry::~SessionRegistry() {
    removed_.close();
    joining_.join();
    for (const auto& [id, session] : sessions_) session->close();
}

std::shared_ptr<Session> SessionRegistry::create(const std::string& id, const Settings& settings,
                                                 const std::string& owner) {
    const std::lock_guard lock(mutex_);
    if (draining_) throw Refusal(Refusal::Kind::unavailable, "the server is shutting down");
    remove_ended();
    if (const auto found = sessions_.find(id); found != sessions_.end()) {
        if (found->second->settings() == settings) return found->second;
        throw Refusal(Refusal::Kind::already_exists, fmt::format("session {} exists with other settings", id));
    }
    if (limits_.sessions != 0 && sessions_.size() >= limits_.sessions)
        throw LimitExceeded(
            fmt::format("{} sessions are open; the server holds at most {}", sessions_.size(), limits_.sessions));
    const BackendOptions backend = place_session();
    auto session = make_session(id, settings, limits_, backend, workers_, owner, metrics_,
                                observe_ ? observe_(id, settings) : nullptr);
    sessions_.emplace(id, session);
    spdlog::info("session {} created on {} ({} open)", id, place_name(backend), sessions_.size());
    return session;
}

std::shared_ptr<Session> SessionRegistry::find(const std::string& id) {
    const std::lock_guard lock(mutex_);
    remove_ended();
    const auto found = sessions_.find(id);
    if (found == sessions_.end()) throw Refusal(Refusal::Kind::not_found, fmt::format("no session {}", id));
    return found->second;
}

std::vector<std::shared_ptr<Session>> SessionRegistry::list() {
    const std::lock_guard lock(mutex_);
    remove_ended();
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
        remove_ended();
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

void SessionRegistry::remove_ended() {
    std::erase_if(sessions_, [this](const auto& entry) {
        const bool ended = entry.second->ended();
        if (ended) removed_.put(entry.second);
        return ended;
    });
}

BackendOptions SessionRegistry::place_session() const {
    if (backend_.backend == Backend::cpu) return backend_;
    const BackendOptions place = place_on(backend_, cuda::devices(devices_));
    if (place.backend == Backend::cpu) spdlog::warn("no GPU answers any more: the next session goes to the CPU");
    return place;
}

void SessionRegistry::drain(std::chrono::duration<double> grace) {
    {
        const std::lock_guard lock(mutex_);
        draining_ = true;
    }
    for (const auto& session : list()) session->drain(grace);
}

}  // namespace meniscus::server
