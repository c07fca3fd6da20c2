// The session that a command opens on a server, and ends again.
#pragma once

#include <optional>
#include <string>

#include "cli/options/server_flags.hpp"
#include "cli/options/session_flags.hpp"
#include "cli/surfaces/interrupts.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::cli {

/// If the command has created it, it ends with the command, also by Ctrl-C, unless it is to be kept or other processes
/// upload to it, too. One without an id of the caller's choice, or of several processes, is ephemeral, so that it ends
/// however they do.
class OpenedSession {
public:
    /// Throws InvalidInput if the server is not there.
    OpenedSession(const ServerFlags& server, const SessionFlags& flags, const Settings& settings,
                  bool has_other_uploaders = false);

    const std::string& id() const { return session_.id(); }
    client::Stream stream(const client::StreamOptions& options) { return session_.stream(options); }
    client::Publisher publish(const client::PublisherOptions& options) { return session_.publish(options); }
    /// Says what went wrong, which the destructor cannot.
    void end();

private:
    client::Client client_;
    std::optional<Interrupts> interrupts_;  ///< outlives the session, whose end may take a while
    client::Session session_;
};

}  // namespace meniscus::cli
