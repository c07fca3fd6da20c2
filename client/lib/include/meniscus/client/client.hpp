// Talks to a meniscusd: opens sessions, pushes particle frames, receives and decodes meshes.
// This header includes neither gRPC nor Draco, so that simulation code need not either.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/brick_coding.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus::client {

/// A call failed: the server is not there, refused, or went away. (Refusals of input are InvalidInput and
/// LimitExceeded, as in process.)
class ServerError : public std::runtime_error {
public:
    /// status: gRPC's, such as "UNAVAILABLE"; empty for what this library has found wrong.
    explicit ServerError(const std::string& message, std::string status = {})
        : std::runtime_error(message), status_(std::move(status)) {}
    const std::string& status() const noexcept { return status_; }

private:
    std::string status_;
};

/// How to connect, and as whom. Files are PEM.
struct ConnectionOptions {
    std::string ca_file = {};           ///< TLS: whose certificates to trust; empty: no TLS
    std::string certificate_file = {};  ///< mutual TLS, with key_file: this client's own
    std::string key_file = {};
    std::string server_name = {};  ///< in the server's certificate; empty: the address's host
    std::string token = {};        ///< sent with every call
    bool insecure = false;         ///< whether a token may travel to another machine without TLS
    /// How long to wait for a host that does not answer. A refused connection is reported at once; see `wait`.
    std::chrono::milliseconds timeout = std::chrono::seconds(10);
    /// For how long a refused connection is tried again, since the server may still be starting.
    std::chrono::milliseconds wait = std::chrono::milliseconds(0);
};

struct ServerInfo {
    std::string version;
    std::string backend;  ///< "cpu" or "cuda"
    std::string device;
    std::string backend_reason;
    unsigned threads = 0;
    std::uint32_t max_sessions = 0;  ///< 0: no limit, here and below
    std::uint32_t max_watchers_per_session = 0;
    std::uint64_t max_particles_per_frame = 0;
    double max_frame_work = 0.0;     ///< times that of as many evenly spread particles
    double max_frame_seconds = 0.0;  ///< on the device
    std::uint64_t max_bytes_per_session = 0;
    std::uint64_t max_device_bytes_per_session = 0;
    std::uint64_t max_bytes_in_flight = 0;    ///< of all sessions' frames
    std::uint32_t max_frames_per_second = 0;  ///< of one session
    std::uint32_t max_chunks_per_frame = 0;
    double max_idle_seconds = 0.0;
    double max_upload_seconds = 0.0;  ///< of a frame that comes more slowly than with the rate that follows
    std::uint64_t min_upload_bytes_per_second = 0;
    double max_orphan_seconds = 0.0;           ///< of a session whose simulator has vanished
    std::uint64_t max_total_bytes = 0;         ///< of all sessions' reconstructions
    std::uint64_t max_total_device_bytes = 0;  ///< of those on one GPU
    double max_idle_buffers_seconds = 0.0;
    std::uint32_t max_sessions_per_name = 0;  ///< of one token's name, or without tokens of one peer address
    std::uint32_t max_watchers_per_name = 0;  ///< of one session
    std::uint32_t max_frames_per_second_per_name = 0;
    std::uint64_t max_bytes_in_flight_per_name = 0;
    std::uint32_t max_connections = 0;           ///< to the gRPC port
    std::uint32_t max_connections_per_peer = 0;  ///< from one address that is no trusted proxy's
    std::uint32_t max_recording_readers = 0;
    std::uint32_t max_formats_per_session = 0;  ///< of meshes, and numbers of particles, that its watchers wish for
    std::uint64_t max_message_bytes = 0;
    std::vector<std::uint32_t> codecs;  ///< numbers of those that the server encodes with; codec.hpp names them
};

/// The server's figures of one frame, beside the reconstruction's own.
struct FrameStatistics : Statistics {
    double encode_seconds = 0.0;
    double latency_seconds = 0.0;  ///< from the frame's last byte to the end of its encoding
    std::uint64_t encoded_bytes = 0;
};

/// What a session's next frame waits for.
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

/// What people call a session, and how viewers show it. A session is told from others by its id alone.
struct SessionDescription {
    std::string name = {};  ///< UTF-8, 1 to 64 characters without control and direction characters; empty: none
    UpAxis up_axis = UpAxis::unspecified;
    std::string length_unit = {};  ///< of the coordinates, such as "m": 1 to 16 characters; empty: not said
};

/// What a session is beside its settings. None of it need be equal to join a session.
struct SessionOptions {
    SessionDescription description = {};
    /// Whether the session ends, watched or not, 5 seconds after it was created or its stream ended, unless a stream is
    /// open by then. Where the connection broke: after StreamOptions::reconnect, if that is longer.
    bool ephemeral = false;
};

struct SessionInfo {
    std::string id;
    std::string owner;  ///< who made it; empty where nobody is asked
    Settings settings;  ///< as in_force() has them
    SessionDescription description;
    bool ephemeral = false;
    std::chrono::system_clock::time_point created_at;
    bool uploading = false;
    unsigned watchers = 0;
    SessionWait waits_for = SessionWait::nothing;
    std::string waits_for_session;  ///< that has the device; told to admins alone
    std::uint64_t frames = 0;
    std::uint64_t frames_dropped = 0;  ///< by the policies of its streams
    std::uint64_t frames_skipped = 0;  ///< replaced before a watcher had taken them, over all watchers
    std::optional<std::uint64_t> last_frame_index;
    std::optional<FrameStatistics> last_frame;  ///< of the frame answered last
};

/// What happens to frames that come faster than the server reconstructs them.
enum class UploadPolicy {
    every_frame,  ///< none is lost: push() waits
    latest,       ///< the newest one replaces the one that waits
    every_nth,    ///< of every n pushed the first is reconstructed; of those none is lost
};
constexpr std::string_view name_of(UploadPolicy policy) {
    switch (policy) {
        case UploadPolicy::every_frame:
            return "every-frame";
        case UploadPolicy::latest:
            return "latest";
        case UploadPolicy::every_nth:
            return "every-nth";
    }
    return {};
}

enum class DropReason {
    replaced,  ///< UploadPolicy::latest
    not_nth,   ///< UploadPolicy::every_nth
};

/// A frame that the server left out, as the policy says.
struct DroppedFrame {
    std::uint64_t index = 0;
    DropReason reason = DropReason::replaced;
};

/// One received frame. Bricks stay encoded until they are asked for.
struct ReceivedFrame {
    std::uint64_t index = 0;
    std::uint64_t run_id = 0;  ///< of the run of frames that the simulator sends; 0: of no run
    double simulation_time = 0.0;
    double cell_size = 0.0;
    std::uint32_t offset_bits = 0;
    /// All of them, ordered by coordinate (z, y, x); empty when no meshes were asked for. A watcher's frames share
    /// those that did not change.
    std::vector<std::shared_ptr<const EncodedBrick>> bricks;
    /// Places of the particles left out of the surface (Spray::points), world units; empty when not asked for.
    std::vector<Point> spray;
    /// To a watcher: the bricks that are new or were received anew since the frame that next() returned before, and
    /// those of that frame which are there no longer. x y z in bricks.
    std::vector<std::array<std::int32_t, 3>> changed;
    std::vector<std::array<std::int32_t, 3>> vanished;
    FrameStatistics statistics;         ///< of the frame as reconstructed, whatever a watcher wishes to have of it
    std::vector<DroppedFrame> dropped;  ///< from a Stream: between the frame received before and this one, in order

    /// Decodes and welds the bricks; has the spray, too. Throws InvalidInput if they are not a mesh.
    Mesh mesh() const;
};

struct StreamOptions {
    bool receive_meshes = true;
    int normal_bits = 8;  ///< 2 to 16, 0 for none
    bool spray = false;   ///< whether the particles left out of the surface come beside the meshes
    /// Received frames that wait for next() at most; push() waits beyond that many frames in flight or waiting.
    /// 0: no limit, for a caller that pushes everything first; frames then wait encoded, in memory.
    std::size_t waiting_limit = 0;
    UploadPolicy policy = UploadPolicy::every_frame;
    std::uint32_t nth = 1;  ///< of UploadPolicy::every_nth, at least 1
    /// For how long the server may be out of reach. A connection that breaks, or a server that goes down, is then tried
    /// again; the session is created again if the server has lost it, and frames without an answer are sent again:
    /// next() returns every frame once, in order. For this their particles are kept here, no more frames than the
    /// server itself has taken and not answered, and one. A stream that the server has ended since nothing came is
    /// opened again with the next frame. 0: a broken connection ends the stream, and no frame is kept.
    std::chrono::milliseconds reconnect{0};
    /// Where a proxy spreads sessions over several servers: how often to look whether calls about this session still go
    /// to the server that the stream is on. If not, because a server came or came back, the stream moves there between
    /// two frames, and watchers with `reconnect` follow it. Only with `reconnect`; 0: never.
    std::chrono::milliseconds route_check{2000};
};

/// Uploads frames and receives their meshes, in order. Reads on a thread of its own, so that a caller that only pushes
/// is never blocked by meshes it has not asked for. push() and finish() belong to one thread, next() to one (other)
/// thread.
class Stream {
public:
    Stream(Stream&&) noexcept;
    Stream& operator=(Stream&&) noexcept;
    ~Stream();  ///< cancels what is in flight

    /// Sends one frame; blocks while the server does not take more, or is out of reach. `index` is greater than the one
    /// before. Throws InvalidInput, LimitExceeded (as the server answered) or ServerError.
    void push(const ParticleFrame& frame, std::uint64_t index, double simulation_time);
    /// No more frames will come; next() then ends after the last one.
    void finish();
    /// Waits for the next received frame; none when the stream has ended well. Throws as push() does.
    std::optional<ReceivedFrame> next();
    /// Frames dropped by the policy so far.
    std::uint64_t dropped() const;

private:
    friend class Client;
    class Impl;
    explicit Stream(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// What a watcher wishes to be sent. Watchers with equal max_level, position_bits and normal_bits cost the server one
/// encode.
struct WatchOptions {
    int normal_bits = 8;                 ///< 2 to 16, 0 for none
    std::optional<int> position_bits{};  ///< vertices lie on multiples of c / 2^position_bits, 2 to the mesh's
                                         ///< offset_bits; none: as reconstructed
    int max_level = 3;            ///< finest level of grid, 1 to 3: below 3 the surface is coarser, and closed as ever
    std::optional<Box> region{};  ///< world units: only bricks that touch it; the mesh ends where they do
    bool spray = false;  ///< whether the particles left out of the surface come beside it: all, whatever the region
    std::uint64_t bytes_per_second = 0;                ///< in the mean: frames are skipped to keep it; 0: no limit
    std::optional<std::array<double, 3>> viewpoint{};  ///< world units: nearest bricks are sent first
    /// How long to try again after the connection breaks, the session moves to another server, or the server goes down,
    /// or comes back without the session, which its simulator then creates again. next() goes on with the first frame
    /// of a run that it has not returned before. 0: not at all.
    std::chrono::milliseconds reconnect{0};
    /// As in StreamOptions: how often to look whether the session goes on with another server. Only with `reconnect`.
    std::chrono::milliseconds route_check{2000};
};

/// Receives a session's meshes, always the newest; frames that came while the caller was busy are skipped by the
/// server.
class Watcher {
public:
    Watcher(Watcher&&) noexcept;
    Watcher& operator=(Watcher&&) noexcept;
    ~Watcher();

    /// Waits for the next frame; none when the session has ended. Throws InvalidInput for a wish out of range,
    /// LimitExceeded or ServerError, also when the server goes down.
    std::optional<ReceivedFrame> next();
    /// Ends a next() that waits in another thread; it then returns none.
    void cancel();

private:
    friend class Client;
    class Impl;
    explicit Watcher(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// Some or all of the particles of a frame. Their surface is the mesh of the frame with the same index and run.
struct ReceivedParticles {
    std::uint64_t index = 0;
    std::uint64_t run_id = 0;
    double simulation_time = 0.0;
    std::uint64_t frame_count = 0;  ///< particles of the frame
    std::uint64_t stride = 1;       ///< of those, every stride-th is here, beginning with the first
    double particle_radius = 0.0;   ///< of level 0, world units
    Box quantization_box;
    std::vector<std::uint16_t> quantized;  ///< x y z per particle: min + q (max - min) / 65535 of quantization_box
    std::vector<std::uint8_t> levels;      ///< empty, or one per particle

    /// Borrows from here.
    ParticleFrame view() const;
};

/// Receives a session's particles, always the newest; frames that came while the caller was busy are skipped by the
/// server.
class ParticleWatcher {
public:
    ParticleWatcher(ParticleWatcher&&) noexcept;
    ParticleWatcher& operator=(ParticleWatcher&&) noexcept;
    ~ParticleWatcher();

    /// Waits for the next frame; none when the session has ended. Throws LimitExceeded or ServerError, also when the
    /// server goes down.
    std::optional<ReceivedParticles> next();
    /// Ends a next() that waits in another thread; it then returns none.
    void cancel();

private:
    friend class Client;
    class Impl;
    explicit ParticleWatcher(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// Frames of a session that the server has kept: one file of its folder of recordings.
struct RecordingInfo {
    std::string session_id;
    std::uint32_t number = 0;  ///< of the session's recordings, from 1
    std::string owner;         ///< who made the session; empty where nobody was asked
    SessionDescription description;
    std::chrono::system_clock::time_point started_at;
    std::uint64_t frames = 0;  ///< those with a mesh, here and below
    std::optional<std::uint64_t> first_frame_index;
    std::optional<std::uint64_t> last_frame_index;
    std::uint64_t bytes = 0;
    bool being_written = false;
    bool damaged = false;  ///< behind the last of these frames
};

/// Which of a recording's frames to read, by their places in it.
struct ReadOptions {
    std::uint64_t position = 0;  ///< of the first, less than RecordingInfo::frames
    std::uint64_t count = 0;     ///< at most; 0: all from there on
    bool spray = false;          ///< whether the particles left out of the surface come beside the meshes
};

/// Reads frames that were recorded, in order.
class RecordingReader {
public:
    RecordingReader(RecordingReader&&) noexcept;
    RecordingReader& operator=(RecordingReader&&) noexcept;
    ~RecordingReader();

    /// Waits for the next frame; none after the last. Throws InvalidInput for a position past the end, LimitExceeded
    /// when too many read, or ServerError.
    std::optional<ReceivedFrame> next();

private:
    friend class Client;
    class Impl;
    explicit RecordingReader(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// A connection to one server. Thread-safe.
class Client {
public:
    /// address: "HOST:PORT" or "unix:PATH". Throws ServerError if the server is not there, InvalidInput if the options
    /// are wrong.
    explicit Client(const std::string& address, const ConnectionOptions& options = {});
    Client(Client&&) noexcept;
    Client& operator=(Client&&) noexcept;
    ~Client();

    ServerInfo server_info();
    /// Whether the server takes calls: false once it shuts down.
    bool serving();
    /// Creates the session (true), or joins it if it exists with equal settings (false); it then keeps its own options.
    bool create_session(const std::string& id, const Settings& settings, const SessionOptions& options = {});
    SessionInfo session(const std::string& id);
    std::vector<SessionInfo> sessions();
    void delete_session(const std::string& id);

    /// The session must exist.
    Stream stream(const std::string& session_id, const StreamOptions& options = {});
    Watcher watch(const std::string& session_id, const WatchOptions& options = {});
    /// max_particles: of a frame with more, only every k-th is sent, by the smallest k that suffices; 0: all.
    /// reconnect: as in WatchOptions.
    ParticleWatcher watch_particles(const std::string& session_id, std::uint64_t max_particles = 0,
                                    std::chrono::milliseconds reconnect = {});

    /// What the server has recorded, the newest first. Throws ServerError (UNIMPLEMENTED) if it records nothing.
    std::vector<RecordingInfo> recordings();
    RecordingReader read_recording(const std::string& session_id, std::uint32_t number,
                                   const ReadOptions& options = {});
    /// Deletes the recording's file. Throws ServerError (FAILED_PRECONDITION) while it is being written or read.
    void delete_recording(const std::string& session_id, std::uint32_t number);

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// A random (version 4) UUID in canonical form.
std::string new_session_id();

}  // namespace meniscus::client
