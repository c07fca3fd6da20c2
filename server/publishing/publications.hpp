// The publications of a server, by the ids of their sessions.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "publishing/publication.hpp"
#include "publishing/publishing_options.hpp"
#include "sessions/handover/timer.hpp"
#include "sessions/session/session_context.hpp"

namespace meniscus::server {

/// Thread-safe. Outlives the sessions that publish.
class Publications {
public:
    /// most_ended: publications of sessions that have ended. Beyond it go those of the owner that has most of them, the
    /// longest ended first.
    Publications(const PublishingOptions& options, std::size_t most_ended);

    /// The observer that publishes a new session. A publication of an earlier session of this id goes on if it had the
    /// same owner and the same settings; otherwise it is replaced.
    std::shared_ptr<SessionObserver> observe(const SessionIdentity& identity, const Settings& settings);
    /// At once, of a session that lives or that has ended. False: there is none, or none that the caller may remove.
    bool remove(const std::string& session_id, const std::function<bool(const std::string& owner)>& may);
    /// Null: there is none.
    std::shared_ptr<const Publication> find(std::string_view session_id) const;

    std::size_t count() const;
    const PublishingCounters& counters() const noexcept { return *counters_; }

    /// Publications lose their oldest frames until all fit, those of the owner whose publications hold most: first
    /// those that have ended, the longest ended before the others, then the largest. So nobody takes from another who
    /// holds less.
    void make_room();
    /// Whether another segment may be sent. What readers still take of segments that have gone is in no other limit.
    bool may_be_sent() const noexcept;
    /// Ends segments whose time is over, and forgets publications whose readers have had their time.
    void tidy(Publication::Clock::time_point now);

private:
    using Entries = std::map<std::string, std::shared_ptr<Publication>, std::less<>>;

    // With the lock held.
    void forget_ended(Publication::Clock::time_point now);

    const PublishingOptions options_;
    const std::size_t most_ended_;
    const std::shared_ptr<PublishingCounters> counters_ = std::make_shared<PublishingCounters>();
    mutable std::mutex mutex_;  ///< for what follows
    Entries entries_;
    Timer timer_;  ///< last: it uses the others
};

}  // namespace meniscus::server
