// What a session's frames are made of: particles or finished bricks, as its first upload has them.
#pragma once

#include <optional>
#include <string>

#include "sessions/intake/upload.hpp"
#include "sessions/limits/refusal.hpp"
#include "sessions/watching/watch_options.hpp"

namespace meniscus::server {

/// Not thread-safe.
class AcceptedFrames {
public:
    /// From here on frames of this kind alone. Throws Refusal, which names the session, if it accepts others.
    void accept(FrameKind kind, const std::string& session);
    /// Whether a watcher can be sent what it asks for.
    bool can_show(const WatchOptions& options) const;
    /// Why it cannot.
    static Refusal needs_particles(const std::string& session);

private:
    std::optional<FrameKind> kind_;  ///< none before the first upload
};

}  // namespace meniscus::server
