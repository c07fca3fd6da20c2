#include "sessions/session_registry.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "log.hpp"
#include "meniscus/devices.hpp"
#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"
#include "sessions/placement.hpp"
#include "sessions/refusal.hpp"

namespace meniscus::server {

namespace {

BackendOptions with_limits(BackendOptions backend, const Limits& limits) {
    backend.memory_limit = limits.bytes_per_session;
    backend.device_memory_limit = limits.device_bytes_per_session;
    backend.work_limit = limits.work_per_frame;
    return backend;
}

/// Often enough that nothing is kept for much longer than the limit says.
std::chrono::milliseconds idle_check_interval(const Limits& limits) {
    return std::clamp(limits.idle_time / 4, std::chrono::milliseconds(10), std::chrono::milliseconds(10'000));
}

std::string place_name(const BackendOptions& backend) {
    return backend.backend == Backend::cuda ? fmt::format("GPU {}", backend.device) : "the CPU";
}

}  // namespace

ReconstructFunctions make_reconstruct(const Settings& settings, const BackendOptions& backend) {
    const auto stop = std::make_shared<StopFlag>();
    BackendOptions stoppable = backend;
    stoppable.stop = stop;
    const auto reconstructor = std::make_shared<Reconstructor>(settings, stoppable);
    return {.reconstruct =
                [reconstructor](const ParticleFrame& frame, Mesh& mesh) {
                    MeshDownload download = reconstructor->reconstruct_for_download(frame, mesh);
                    return Reconstructed(reconstructor->statistics(), std::move(download));
                },
            .emit_capped = [reconstructor](int max_level, Mesh& mesh) { reconstructor->emit_capped(max_level, mesh); },
            .stop = stop};
}

SessionRegistry::SessionRegistry(const Limits& limits, const BackendOptions& backend, unsigned encoding_threads,
                                 std::vector<int> devices, std::shared_ptr<Metrics> metrics, Observe observe,
                                 MakeReconstruct make)
    : limits_(limits),
      backend_(with_limits(backend, limits)),
      devices_(std::move(devices)),
      observe_(std::move(observe)),
      make_reconstruct_(std::move(make)),
      workers_(std::make_shared<WorkerPool>(encoding_threads)),
      metrics_(std::move(metrics)),
      bytes_in_flight_(std::make_shared<BytesInFlight>(limits.bytes_in_flight)) {
    joining_ = std::thread([this] {
        while (const auto session = removed_.take()) (*session)->join();
    });
    if (limits.idle_time.count() != 0)
        idle_check_.emplace(idle_check_interval(limits), [this] { end_idle(std::chrono::steady_clock::now()); });
}

SessionRegistry::~SessionRegistry() {
    idle_check_.reset();
    removed_.close();
    joining_.join();
    for (const auto& [id, session] : sessions_) session->close();
}

std::shared_ptr<Session> SessionRegistry::create(const std::string& id, const Settings& settings,
                                                 const std::string& owner) {
    const std::lock_guard lock(mutex_);
    if (draining_) throw shutting_down();
    remove_ended();
    if (const auto found = sessions_.find(id); found != sessions_.end()) {
        if (found->second->settings() == settings) {
            found->second->touch();
            return found->second;
        }
        throw Refusal(Refusal::Kind::already_exists, fmt::format("session {} exists with other settings", id));
    }
    if (limits_.sessions != 0 && sessions_.size() >= limits_.sessions)
        throw LimitExceeded(
            fmt::format("{} sessions are open; the server holds at most {}", sessions_.size(), limits_.sessions));
    const BackendOptions backend = place_session();
    auto session = std::make_shared<Session>(SessionIdentity{.id = id, .owner = owner}, settings, limits_,
                                             make_reconstruct_(settings, backend), shared_on(backend),
                                             observe_ ? observe_(id, settings, owner) : nullptr);
    sessions_.emplace(id, session);
    log_info({.session = id}, "created on {} ({} open)", place_name(backend), sessions_.size());
    return session;
}

std::shared_ptr<Session> SessionRegistry::find(const std::string& id) {
    const std::lock_guard lock(mutex_);
    remove_ended();
    const auto found = sessions_.find(id);
    if (found == sessions_.end()) throw Refusal(Refusal::Kind::not_found, fmt::format("no session {}", id));
    found->second->touch();
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

void SessionRegistry::remove(const std::shared_ptr<Session>& session) {
    std::size_t left = 0;
    {
        const std::lock_guard lock(mutex_);
        remove_ended();
        const auto found = sessions_.find(session->id());
        if (found == sessions_.end() || found->second != session)
            throw Refusal(Refusal::Kind::not_found, fmt::format("no session {}", session->id()));
        sessions_.erase(found);
        left = sessions_.size();
    }
    session->close();
    log_info({.session = session->id()}, "deleted ({} open)", left);
    removed_.put(session);
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

SharedResources SessionRegistry::shared_on(const BackendOptions& place) {
    constexpr int cpu = -1;
    auto& turns = turns_[place.backend == Backend::cuda ? place.device : cpu];
    if (!turns) turns = std::make_shared<Turns>();
    return {.workers = workers_,
            .metrics = metrics_,
            .turns = turns,
            .bytes_in_flight = bytes_in_flight_,
            .deadlines = deadlines_};
}

std::chrono::duration<double> SessionRegistry::busy_time() {
    const std::lock_guard lock(mutex_);
    std::chrono::duration<double> sum{};
    for (const auto& [device, turns] : turns_) sum += turns->taken();
    return sum;
}

void SessionRegistry::drain(std::chrono::duration<double> grace) {
    {
        const std::lock_guard lock(mutex_);
        draining_ = true;
    }
    for (const auto& session : list()) session->drain(grace);
}

void SessionRegistry::end_idle(std::chrono::steady_clock::time_point now) {
    for (const auto& session : list()) {
        if (!session->end_idle(now)) continue;
        {
            const std::lock_guard lock(mutex_);
            // Somebody may have found it, or removed it, in the meantime.
            const auto found = sessions_.find(session->id());
            if (found == sessions_.end() || found->second != session || !session->end_idle(now)) continue;
            sessions_.erase(found);
        }
        session->close();
        log_info({.session = session->id()}, "removed: nobody has used it for {:.3g} s",
                 std::chrono::duration<double>(limits_.idle_time).count());
        removed_.put(session);
    }
}

}  // namespace meniscus::server
