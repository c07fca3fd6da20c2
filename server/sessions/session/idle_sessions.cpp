#include "sessions/session/idle_sessions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "meniscus/seconds.hpp"
#include "sessions/session/session_name.hpp"

namespace meniscus::server {

namespace {

/// A status travels in metadata, of which clients take 8 KiB; a name may have 768 bytes there.
constexpr std::size_t most_named = 5;

}  // namespace

std::string name_idle_sessions(const std::vector<std::shared_ptr<Session>>& sessions,
                               const std::function<bool(const std::string& owner)>& may_see,
                               std::chrono::steady_clock::time_point now) {
    using Duration = std::chrono::steady_clock::duration;
    std::vector<std::pair<Duration, const Session*>> idle;
    for (const auto& session : sessions) {
        const auto time = session->without_stream(now);
        if (time && (!may_see || may_see(session->owner()))) idle.emplace_back(*time, session.get());
    }
    std::ranges::stable_sort(idle, std::ranges::greater(), [](const auto& entry) { return entry.first; });
    if (idle.size() > most_named) idle.resize(most_named);
    if (idle.empty()) return "; none of them is idle and may be deleted by you: try again later";
    std::string text = "; you may delete, of those without a stream, ";
    for (const auto& [time, session] : idle)
        text += fmt::format("{}{}{} (for {:.0f} s)", session == idle.front().second ? "" : ", ", named(session->name()),
                            session->id(), seconds_of(time));
    if (const std::size_t others = sessions.size() - idle.size(); others != 0)
        text += fmt::format("; others: {}", others);
    return text;
}

}  // namespace meniscus::server
