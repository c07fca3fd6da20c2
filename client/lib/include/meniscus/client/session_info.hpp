// The description and the state of a session.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "meniscus/client/frame_statistics.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::client {

/// The cause for which a session's next frame waits.
enum class SessionWait {
    nothing,
    device,           ///< its turn
    bytes_in_flight,  ///< room among those of all sessions
    something_else,   ///< that this version does not know
};

/// The axis of the coordinates that points up.
enum class UpAxis { unspecified, x, y, z };
constexpr std::string_view name_of(UpAxis axis) {
    switch (axis) {
        case UpAxis::unspecified:
            return "unspecified";
        case UpAxis::x:
            return "x";
        case UpAxis::y:
            return "y";
        case UpAxis::z:
            return "z";
    }
    return {};
}

/// The name of a session for people, and how viewers show it. Its id alone distinguishes it from others.
struct SessionDescription {
    std::string name = {};  ///< UTF-8, 1 to 64 characters without control and direction characters; empty: none
    UpAxis up_axis = UpAxis::unspecified;
    std::string length_unit = {};  ///< of the coordinates, such as "m": 1 to 16 characters; empty: not said

    template <class Visit>
    static void rows(const Visit& visit) {
        using D = SessionDescription;
        visit("name", &D::name, {.help = "what people call the session, 1 to 64 characters"});
        visit("up_axis", &D::up_axis, {.help = "axis that viewers show upright"});
        visit("length_unit", &D::length_unit, {.help = "unit of the coordinates, such as m, 1 to 16 characters"});
    }
};

/// The options of a session beside its settings. None of them need be equal to join a session.
struct SessionOptions {
    SessionDescription description = {};
    /// Whether the session ends, watched or not, 5 seconds after it was created or its stream ended, unless a stream is
    /// open by then. Where the connection broke: after StreamOptions::reconnect, if that is longer.
    bool ephemeral = false;
    /// Whether a stream is about to be opened to it. Until one is, the server takes a session for one whose simulator
    /// has vanished (ServerInfo::max_orphan_seconds), unless it is watched.
    bool stream_follows = false;
    /// Whether the server publishes the session's meshes as plain files, /publications/ID/manifest.json on its HTTP
    /// port, for callers that may watch it. Throws ServerError (failed_precondition) where the server publishes nothing
    /// (ServerInfo::publishes), and where the session is there and is not published.
    bool publish = false;
};

struct DeleteOptions {
    /// Whether what the session has published goes with it, at once, also of a session that has ended before. Otherwise
    /// readers have it for some time more.
    bool unpublish = false;
};

struct SessionInfo {
    std::string id;
    std::string owner;  ///< its maker; empty where names are not asked for
    Settings settings;  ///< as in_force() has them
    SessionDescription description;
    bool ephemeral = false;
    bool published = false;  ///< as SessionOptions::publish asks
    std::chrono::system_clock::time_point created_at;
    bool uploading = false;
    unsigned watchers = 0;
    SessionWait waits_for = SessionWait::nothing;
    std::string waits_for_session;  ///< that has the device; only admins see it
    std::uint64_t frames = 0;
    std::uint64_t frames_dropped = 0;  ///< by the policies of its streams
    std::uint64_t frames_skipped = 0;  ///< replaced before a watcher had taken them, over all watchers
    std::optional<std::uint64_t> last_frame_index;
    std::optional<FrameStatistics> last_frame;  ///< of the frame answered last
};

}  // namespace meniscus::client
