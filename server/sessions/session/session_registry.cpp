#include "sessions/session/session_registry.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "meniscus/devices.hpp"
#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"
#include "process/call_log.hpp"
#include "process/freed_memory.hpp"
#include "sessions/limits/limit_reached.hpp"
#include "sessions/limits/refusal.hpp"
#include "sessions/session/idle_sessions.hpp"
#include "sessions/session/placement.hpp"
#include "sessions/session/session_name.hpp"

namespace meniscus::server {

namespace {

BackendOptions with_limits(BackendOptions backend, const Limits& limits) {
    backend.memory_limit = limits.bytes_per_session;
    backend.device_memory_limit = limits.device_bytes_per_session;
    backend.work_limit = limits.work_per_frame;
    return backend;
}

/// Often enough that nothing is kept for much longer than the limit says, and no frame waits for much longer than
/// BytesInFlight's patience before it is next; 0 if nothing has a limit.
std::chrono::milliseconds idle_check_interval(const Limits& limits) {
    using std::chrono::milliseconds;
    auto interval = milliseconds::max();
    for (const auto time : {limits.idle_time, limits.orphan_time, limits.ephemeral_time, limits.idle_buffers_time,
                            limits.least_pace.time})
        if (time.count() != 0) interval = std::min(interval, time / 4);
    if (limits.bytes_in_flight != 0) interval = std::min<milliseconds>(interval, BytesInFlight::patience);
    if (interval == milliseconds::max()) return {};
    return std::clamp(interval, milliseconds(10), milliseconds(10'000));
}

std::string place_name(const BackendOptions& backend) {
    return backend.backend == Backend::cuda ? fmt::format("GPU {}", backend.device) : "the CPU";
}

std::shared_ptr<PagePinning> pinning_that_logs_refusals(int device) {
    return cuda::page_pinning(device, [device](const std::string& reason) {
        spdlog::warn("GPU {} copies more slowly: memory cannot be pinned for it ({})", device, reason);
    });
}

}  // namespace

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
      bytes_in_flight_(std::make_shared<BytesInFlight>(limits.bytes_in_flight, limits.sessions)),
      memory_(shared_memory(limits.total_bytes)),
      snapshots_(limits.snapshots, limits.snapshots_per_name) {
    // First: it ends by itself where the system refuses the thread below.
    if (const auto interval = idle_check_interval(limits); interval.count() != 0)
        idle_check_.emplace().every(interval, [this] { end_idle(std::chrono::steady_clock::now()); });
    joining_ = std::thread([this] {
        while (auto session = removed_.take().value_or(nullptr)) {
            session->join();
            if (const auto& account = session->account()) --account->ending;
            session.reset();
            --ending_;
            sessions_have_ended_ = true;
        }
    });
}

SessionRegistry::~SessionRegistry() {
    idle_check_.reset();
    for (const auto& [id, session] : sessions_) session->close("the server goes down");
    remove_ended();
    removed_.put(nullptr);
    joining_.join();
}

SessionRegistry::Created SessionRegistry::create(const std::string& id, const Settings& settings,
                                                 const Creator& creator, const SessionKind& kind) {
    const std::lock_guard lock(mutex_);
    if (draining_) throw shutting_down();
    remove_ended();
    if (const auto found = sessions_.find(id); found != sessions_.end()) {
        // Rights come before settings: a refusal must not say whether another caller's settings differ.
        if (creator.may_see && !creator.may_see(found->second->owner()))
            throw Refusal(Refusal::Kind::permission_denied,
                          fmt::format("session {} is not one of {}'s: choose another id", id, creator.name));
        if (kind.publish && !found->second->kind().publish)
            throw Refusal(Refusal::Kind::failed_precondition,
                          fmt::format("session {} exists and is not published: join it without publish, or create "
                                      "another one",
                                      id));
        if (found->second->settings() == settings) {
            found->second->touch();
            found->second->await_stream();
            return {.session = found->second};
        }
        throw Refusal(Refusal::Kind::already_exists, fmt::format("session {} exists with other settings", id));
    }
    require_room(creator);
    BackendOptions backend = place_session();
    backend.shared_memory = memory_;
    if (backend.backend == Backend::cuda) {
        auto& device = device_memory_[backend.device];
        if (!device) device = shared_memory(limits_.total_device_bytes);
        backend.shared_device_memory = device;
        auto& pinning = pinning_[backend.device];
        if (!pinning) pinning = pinning_that_logs_refusals(backend.device);
        backend.pinning = pinning;
        backend.notice = [device = backend.device](const std::string& what) {
            spdlog::warn("GPU {} is slower: {}", device, what);
        };
    }
    const SessionIdentity identity{.id = id, .owner = creator.name, .account = creator.account, .kind = kind};
    auto session =
        std::make_shared<Session>(identity, settings, limits_, make_reconstruct_(settings, backend), shared_on(backend),
                                  observe_ ? observe_(identity, settings) : SessionObservers{});
    sessions_.emplace(id, session);
    idle_buffers_->add(session);
    call_log.write({.session = id}, "{}created on {}{} ({} open)", named(session->name()), place_name(backend),
                   kind.ephemeral ? ", ephemeral" : "", sessions_.size());
    return {.session = std::move(session), .is_new = true};
}

std::shared_ptr<Session> SessionRegistry::find(const std::string& id, const MaySee& may_see, Look look) {
    const std::lock_guard lock(mutex_);
    remove_ended();
    const auto found = sessions_.find(id);
    if (found == sessions_.end() || (may_see && !may_see(found->second->owner())))
        throw Refusal(Refusal::Kind::not_found, fmt::format("no session {}", id));
    if (look == Look::uses_it) found->second->touch();
    return found->second;
}

std::vector<std::shared_ptr<Session>> SessionRegistry::list() {
    const std::lock_guard lock(mutex_);
    remove_ended();
    return sessions_of(nullptr);
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
        let_end(session);
    }
    session->close();
    call_log.write({.session = session->id()}, "deleted ({} open)", left);
}

void SessionRegistry::require_room(const Creator& creator) const {
    if (limits_.sessions != 0 && sessions_.size() >= limits_.sessions)
        throw LimitReached(LimitName::sessions,
                           fmt::format("{} sessions are open; the server holds at most {}{}", sessions_.size(),
                                       limits_.sessions, name_idle_sessions(sessions_of(nullptr), creator.may_see)));
    // An equal number may be about to end, so that a session can take the place of one that was just deleted.
    if (limits_.sessions != 0 && sessions_.size() + ending_ >= std::size_t{2} * limits_.sessions)
        throw LimitReached(
            LimitName::sessions,
            fmt::format("{} sessions that were deleted have not ended yet, beside {} open ones; the server holds at "
                        "most {} of both: try again later",
                        ending_.load(), sessions_.size(), std::size_t{2} * limits_.sessions));
    if (creator.account) require_share(creator);
}

void SessionRegistry::require_share(const Creator& creator) const {
    const NameAccount& account = *creator.account;
    const std::uint32_t share = account.shares().sessions;
    if (share == 0) return;
    const auto open = sessions_of(&account);
    const std::uint32_t ending = account.ending;
    if (open.size() >= share)
        throw LimitReached(LimitName::sessions_per_name,
                           fmt::format("{} has {} sessions; the server holds at most {} of one caller{}",
                                       account.name(), open.size(), share, name_idle_sessions(open, creator.may_see)));
    if (open.size() + ending >= std::size_t{2} * share)
        throw LimitReached(
            LimitName::sessions_per_name,
            fmt::format("{} has {} sessions, and {} that were deleted have not ended yet; the server holds at most {} "
                        "of one caller, and {} of both: try again later",
                        account.name(), open.size(), ending, share, std::uint64_t{2} * share));
}

std::vector<std::shared_ptr<Session>> SessionRegistry::sessions_of(const NameAccount* account) const {
    std::vector<std::shared_ptr<Session>> sessions;
    for (const auto& [id, session] : sessions_)
        if (account == nullptr || session->account().get() == account) sessions.push_back(session);
    return sessions;
}

void SessionRegistry::remove_ended() {
    std::erase_if(sessions_, [this](const auto& entry) {
        const bool ended = entry.second->ended();
        if (ended) let_end(entry.second);
        return ended;
    });
}

void SessionRegistry::let_end(std::shared_ptr<Session> session) {
    ++ending_;
    if (session->account()) ++session->account()->ending;
    removed_.put(std::move(session));
}

BackendOptions SessionRegistry::place_session() const {
    if (backend_.backend == Backend::cpu) return backend_;
    BackendOptions place = place_on(backend_, cuda::devices(devices_), cuda::answers);
    if (place.backend == Backend::cpu) spdlog::warn("no GPU answers any more: the next session goes to the CPU");
    return place;
}

std::shared_ptr<SharedMemory> SessionRegistry::shared_memory(std::size_t limit) {
    const auto memory = std::make_shared<std::weak_ptr<SharedMemory>>();
    // A call may keep a session for longer than there is a registry.
    auto shared = std::make_shared<SharedMemory>(limit, [idle = idle_buffers_, memory](std::size_t missing) {
        const auto self = memory->lock();
        const auto room = [&] { return self->limit() - std::min(self->limit(), self->bytes()); };
        const std::size_t wanted = room() + missing;
        idle->make_room([&] { return room() >= wanted; });
        if (room() < wanted) idle->note_shortage();
    });
    *memory = shared;
    return shared;
}

SharedResources SessionRegistry::shared_on(const BackendOptions& place) {
    constexpr int cpu = -1;
    const bool is_gpu = place.backend == Backend::cuda;
    auto& turns = turns_[is_gpu ? place.device : cpu];
    if (!turns) turns = is_gpu ? std::make_shared<Turns>() : std::make_shared<Turns>(limits_.turn_time);
    return {.workers = workers_,
            .metrics = metrics_,
            .turns = turns,
            .memory = memory_,
            .pinning = place.pinning,
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
    const std::lock_guard one_at_a_time(idle_check_mutex_);
    const auto released = std::erase_if(releases_, [](const std::future<void>& release) {
        return release.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    if (sessions_have_ended_.exchange(false) || released != 0) return_free_pages();
    bytes_in_flight_->look_again();
    const bool memory_is_short = idle_buffers_->short_within(limits_.least_pace.time + std::chrono::minutes(1));
    for (const auto& session : list()) {
        const auto resting_since = session->resting_since();
        if (limits_.idle_buffers_time.count() != 0 && resting_since &&
            now - *resting_since >= limits_.idle_buffers_time)
            releases_.push_back(session->release_buffers());
        session->end_idle_upload(now, memory_is_short);
        if (!session->unused(now)) continue;
        std::optional<std::string> reason;
        {
            const std::lock_guard lock(mutex_);
            // Somebody may have found it, or removed it, in the meantime.
            const auto found = sessions_.find(session->id());
            if (found == sessions_.end() || found->second != session) continue;
            reason = session->unused(now);
            if (!reason) continue;
            sessions_.erase(found);
            let_end(session);
        }
        session->close(*reason);
        call_log.write({.session = session->id()}, "removed: {}", *reason);
    }
}

}  // namespace meniscus::server
