// One watcher in its session: a slot for the newest frame, and the rest of the frame that is being sent.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>

#include "sessions/limits/name_account.hpp"
#include "sessions/limits/token_bucket.hpp"
#include "sessions/sending/encoded_frame.hpp"
#include "sessions/sending/metrics.hpp"
#include "sessions/watching/mesh_update.hpp"
#include "sessions/watching/particle_messages.hpp"
#include "sessions/watching/watch_options.hpp"

namespace meniscus::server {

/// Meshes or particles.
using WatchedFrame = std::variant<std::shared_ptr<const EncodedFrame>, std::shared_ptr<const ParticleMessages>>;

/// A watcher that lags finds the newest frame here, never a backlog. The session puts frames in. The writer to the
/// watcher takes messages out, one by one: each frame's difference to the last one that went out whole.
class Watch {
public:
    using Clock = std::chrono::steady_clock;

    /// A write that takes longer means that the watcher has stopped reading. The rest of its frame is then given up for
    /// the next one that is put, so that a stalled watcher keeps no old encode alive.
    static constexpr Clock::duration stalled_after = std::chrono::seconds(2);

    struct Nothing {};  ///< yet: `wake` will be called
    struct Later {
        Clock::time_point at;  ///< as the watcher's rate allows; `wake` is called if there is reason to come earlier
    };
    struct End {
        std::exception_ptr error;  ///< none: all went well
    };
    using Next = std::variant<Nothing, Later, SharedMessage, End>;

    struct Progress {
        std::uint64_t frames_skipped = 0;  ///< replaced before they were taken, or given up
        Clock::duration lag{};             ///< since the oldest frame that it has not taken whole; 0: it has the newest
    };

    /// wake: called once, by a producing thread, after take() has found nothing and there is something again;
    /// and by finish().
    Watch(const WatchOptions& options, std::function<void()> wake,
          std::shared_ptr<Metrics> metrics = std::make_shared<Metrics>(),
          std::shared_ptr<const NameAccount> account = nullptr);

    const WatchOptions& options() const noexcept { return options_; }
    /// The watcher's account; may be none.
    const std::shared_ptr<const NameAccount>& account() const noexcept { return account_; }

    // The session's side.

    /// frame: in the form that the watcher asks for. Replaces a frame that has not been taken. It is the last where
    /// the watcher asks for one alone.
    void put(WatchedFrame frame, Clock::time_point now = Clock::now());
    /// Announces to the watcher, between two messages, that the server goes down after this time.
    void announce_end(std::chrono::duration<double> grace);
    /// No frames follow those that are here now, which go out without waiting for the rate. Later calls do nothing.
    void finish(std::exception_ptr error);
    bool is_finished() const;
    Progress progress(Clock::time_point now = Clock::now()) const;

    // The writer's side, one thread at a time.

    /// The next message. The one before has been written.
    Next take(Clock::time_point now = Clock::now());

private:
    enum class Waits { no, for_the_rate, for_a_frame };

    SharedMessage next_message(Clock::time_point now);

    const WatchOptions options_;
    const std::function<void()> wake_;
    const std::shared_ptr<Metrics> metrics_;
    const std::shared_ptr<const NameAccount> account_;

    mutable std::mutex mutex_;            ///< for what follows
    std::optional<WatchedFrame> newest_;  ///< not begun yet
    Clock::time_point newest_since_;      ///< when this slot was last filled while it was empty
    FrameUpdate update_;                  ///< what is left of the frame that is being sent
    std::optional<WatcherMesh> sent_;     ///< the last mesh that went out whole
    std::optional<TokenBucket> bucket_;
    Clock::time_point received_at_;  ///< the particles of the frame that is being sent
    bool ending_ = false;            ///< its last message is being written
    std::optional<Clock::time_point> writing_since_;
    std::optional<Clock::time_point> behind_since_;
    std::uint64_t skipped_ = 0;
    SharedMessage draining_;
    std::exception_ptr error_;
    bool finished_ = false;
    Waits waits_ = Waits::no;
};

}  // namespace meniscus::server
