// Talks to a meniscusd: opens sessions, pushes particle frames, receives and decodes meshes.
// This header includes neither gRPC nor Draco, so that simulation code need not either.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "meniscus/client/connection_options.hpp"
#include "meniscus/client/errors.hpp"
#include "meniscus/client/frame_statistics.hpp"
#include "meniscus/client/particle_watcher.hpp"
#include "meniscus/client/publisher.hpp"
#include "meniscus/client/received_frame.hpp"
#include "meniscus/client/recording.hpp"
#include "meniscus/client/server_info.hpp"
#include "meniscus/client/session.hpp"
#include "meniscus/client/session_info.hpp"
#include "meniscus/client/stream.hpp"
#include "meniscus/client/watcher.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::client {

/// A connection to one server. Thread-safe. A call that is answered once ends with ServerError (canceled) when its stop
/// is requested.
class Client {
public:
    /// address: "HOST:PORT", "HOST" for port 50051, or "unix:PATH"; IPv6 stands in brackets. Throws ServerError if the
    /// server is not there, InvalidInput if the address or the options are wrong.
    explicit Client(const std::string& address, const ConnectionOptions& options = {});
    Client(Client&&) noexcept;
    Client& operator=(Client&&) noexcept;
    ~Client();

    ServerInfo server_info(const std::stop_token& stop = {});
    /// Whether the server takes calls: false once it shuts down.
    bool serving(const std::stop_token& stop = {});
    /// Opens a session that ends with the object returned, unless it was there before: create_session() and, in time,
    /// delete_session().
    Session open_session(const Settings& settings, const OpenOptions& options = {});
    /// Creates the session (true), or joins it if it exists with equal settings (false); it then keeps its own options.
    bool create_session(const std::string& id, const Settings& settings, const SessionOptions& options = {},
                        const std::stop_token& stop = {});
    SessionInfo session(const std::string& id, const std::stop_token& stop = {});
    std::vector<SessionInfo> sessions(const std::stop_token& stop = {});
    void delete_session(const std::string& id, const DeleteOptions& options = {}, const std::stop_token& stop = {});

    /// The session must exist.
    Stream stream(const std::string& session_id, const StreamOptions& options = {});
    /// The session must exist, and have had no particles.
    Publisher publish(const std::string& session_id, const PublisherOptions& options = {});
    Watcher watch(const std::string& session_id, const WatchOptions& options = {});
    /// The session's newest mesh; none if no frame has come yet. Throws InvalidInput, LimitExceeded where too many
    /// snapshots are under way, or ServerError.
    std::optional<ReceivedFrame> snapshot(const std::string& session_id, const SnapshotOptions& options = {});
    ParticleWatcher watch_particles(const std::string& session_id, const ParticleWatchOptions& options);
    ParticleWatcher watch_particles(const std::string& session_id, std::uint64_t max_particles = 0,
                                    std::chrono::milliseconds reconnect = {});

    /// The server's recordings, the newest first. Throws ServerError (UNIMPLEMENTED) if it records nothing.
    std::vector<RecordingInfo> recordings(const std::stop_token& stop = {});
    RecordingReader read_recording(const std::string& session_id, std::uint32_t number,
                                   const ReadOptions& options = {});
    /// Deletes the recording's file. Throws ServerError (FAILED_PRECONDITION) while it is being written or read.
    void delete_recording(const std::string& session_id, std::uint32_t number, const std::stop_token& stop = {});

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// A random (version 4) UUID in canonical form.
std::string new_session_id();

}  // namespace meniscus::client
