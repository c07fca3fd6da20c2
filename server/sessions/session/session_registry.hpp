// All sessions of a server, by their ids.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "meniscus/backend_options.hpp"
#include "meniscus/settings.hpp"
#include "sessions/handover/channel.hpp"
#include "sessions/handover/timer.hpp"
#include "sessions/limits/limits.hpp"
#include "sessions/limits/snapshot_places.hpp"
#include "sessions/session/idle_buffers.hpp"
#include "sessions/session/session.hpp"

namespace meniscus::server {

/// Makes the observers of a new session. Throws Refusal for one that cannot be observed as its kind asks.
using Observe = std::function<SessionObservers(const SessionIdentity& identity, const Settings& settings)>;

/// Makes the functions that a new session reconstructs with.
using MakeReconstruct = std::function<ReconstructFunctions(const Settings& settings, const BackendOptions& backend)>;

/// Whether the sessions of this owner exist for a caller.
using MaySee = std::function<bool(const std::string& owner)>;

/// The caller that creates a session.
struct Creator {
    std::string name{};                      ///< empty where callers have no names
    std::shared_ptr<NameAccount> account{};  ///< none: no limits of its own
    MaySee may_see{};                        ///< empty: all
};

class SessionRegistry {
public:
    /// encoding_threads: at least 1. devices: the GPUs that sessions may use; all if none is named. observe: may be
    /// empty.
    SessionRegistry(const Limits& limits, const BackendOptions& backend, unsigned encoding_threads,
                    std::vector<int> devices = {}, std::shared_ptr<Metrics> metrics = std::make_shared<Metrics>(),
                    Observe observe = nullptr, MakeReconstruct make = make_reconstruct);
    /// Ends all sessions, and returns once their threads have ended.
    ~SessionRegistry();
    SessionRegistry(const SessionRegistry&) = delete;
    SessionRegistry& operator=(const SessionRegistry&) = delete;

    struct Created {
        std::shared_ptr<Session> session;
        bool is_new = false;
    };
    /// Returns the session that exists with equal settings, which stays of the kind that it is, or a new one, which is
    /// the creator's. Throws InvalidInput (of settings), LimitExceeded, Refusal, DeviceError.
    Created create(const std::string& id, const Settings& settings, const Creator& creator = {},
                   const SessionKind& kind = {});
    enum class Look : std::uint8_t { uses_it, leaves_it_idle };
    /// Throws Refusal, not_found, if there is none that the caller may see.
    std::shared_ptr<Session> find(const std::string& id, const MaySee& may_see = nullptr, Look look = Look::uses_it);
    /// Ordered by id.
    std::vector<std::shared_ptr<Session>> list();
    /// Ends the session, its stream and its watchers; its threads end in the background. Throws Refusal if it has gone,
    /// also where another one has its id by now.
    void remove(const std::shared_ptr<Session>& session);

    /// No new sessions and uploads; those that run end after the frame on its way in. Returns at once. grace: after it,
    /// the server ends the calls that are left.
    void drain(std::chrono::duration<double> grace);
    /// Ends the streams, and forgets the sessions, that have been idle for too long; see Session.
    void end_idle(std::chrono::steady_clock::time_point now);

    const Limits& limits() const noexcept { return limits_; }
    /// Bytes of the frames of all sessions.
    std::size_t bytes_in_flight() const noexcept { return bytes_in_flight_->bytes(); }
    /// Host memory that all reconstructions hold.
    std::size_t reconstruction_bytes() const noexcept { return memory_->bytes(); }
    /// The time that all devices together have spent on frames since the start.
    std::chrono::duration<double> busy_time();
    Metrics& metrics() const noexcept { return *metrics_; }
    SnapshotPlaces& snapshots() noexcept { return snapshots_; }
    /// The memory of all sessions.
    const std::shared_ptr<SharedMemory>& memory() const noexcept { return memory_; }
    /// A caller's account. name: of its token, or its address. own: what the tokens file says of it.
    std::shared_ptr<NameAccount> account(const std::string& name, const OwnShares& own = {}) {
        return accounts_.of(name, own.over(limits_.per_name));
    }

private:
    // With the lock held.

    /// Throws LimitExceeded if there is no room for another session of this caller.
    void require_room(const Creator& creator) const;
    void require_share(const Creator& creator) const;
    /// account: none: of all.
    std::vector<std::shared_ptr<Session>> sessions_of(const NameAccount* account) const;
    /// Forgets the sessions that ended by themselves.
    void remove_ended();
    /// The session is no longer in the map; its threads end in the background.
    void let_end(std::shared_ptr<Session> session);
    /// The resources that sessions on this place share.
    SharedResources shared_on(const BackendOptions& place);

    /// Where the next session reconstructs.
    BackendOptions place_session() const;
    /// Memory of at most `limit` bytes, for which idle sessions give theirs back.
    std::shared_ptr<SharedMemory> shared_memory(std::size_t limit);

    const Limits limits_;
    const BackendOptions backend_;
    const std::vector<int> devices_;
    const Observe observe_;
    const MakeReconstruct make_reconstruct_;
    const std::shared_ptr<WorkerPool> workers_;
    const std::shared_ptr<Metrics> metrics_;
    const std::shared_ptr<BytesInFlight> bytes_in_flight_;
    const std::shared_ptr<Timer> deadlines_ = std::make_shared<Timer>();
    const std::shared_ptr<IdleBuffers> idle_buffers_ = std::make_shared<IdleBuffers>();
    const std::shared_ptr<SharedMemory> memory_;

    NameAccounts accounts_;
    SnapshotPlaces snapshots_;

    std::mutex mutex_;
    std::map<std::string, std::shared_ptr<Session>> sessions_;
    std::map<int, std::shared_ptr<Turns>> turns_;                 ///< by device
    std::map<int, std::shared_ptr<SharedMemory>> device_memory_;  ///< by device
    std::map<int, std::shared_ptr<PagePinning>> pinning_;         ///< by device
    bool draining_ = false;

    // Joins the threads of sessions that were removed: no gRPC thread has to wait for a reconstruction, and no thread
    // of a session, which wakes streams that hold it, has the last reference to it.
    std::atomic<std::uint32_t> ending_{0};       ///< sessions that were removed, and whose threads may run still
    Channel<std::shared_ptr<Session>> removed_;  ///< null: none follows
    std::thread joining_;
    std::atomic<bool> sessions_have_ended_{false};  ///< since free pages were returned

    std::mutex idle_check_mutex_;              ///< of end_idle(), for what follows
    std::vector<std::future<void>> releases_;  ///< of buffers, that were not over then
    std::optional<Timer> idle_check_;          ///< last: it uses the others
};

}  // namespace meniscus::server
