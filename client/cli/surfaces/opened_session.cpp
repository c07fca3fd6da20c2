#include "cli/surfaces/opened_session.hpp"

#include <exception>

namespace meniscus::cli {

OpenedSession::OpenedSession(const ServerFlags& server, const SessionFlags& flags, const Settings& settings,
                             bool has_other_uploaders)
    : client_(server.connect()),
      session_(client_.open_session(settings, {.description = flags.description,
                                               .id = flags.id,
                                               .ephemeral = (flags.id.empty() || has_other_uploaders) && !flags.keep,
                                               .stream_follows = true,
                                               .publish = flags.publish})) {
    if (flags.keep || has_other_uploaders) session_.leave();
    if (!session_.is_owned()) return;
    interrupts_.emplace([end = session_.ending()] {
        try {
            end();
        } catch (const std::exception&) {
            // The process ends, and an ephemeral session after it.
        }
    });
}

void OpenedSession::end() {
    session_.end();
}

}  // namespace meniscus::cli
