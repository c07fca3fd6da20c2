// A simulator's stream: particle frames out, meshes in.
#pragma once

#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string_view>
#include <utility>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/client/next.hpp"
#include "meniscus/client/normals_by.hpp"
#include "meniscus/client/particle_buffer.hpp"
#include "meniscus/client/received_frame.hpp"
#include "meniscus/client/reconnect_event.hpp"
#include "meniscus/codec.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/strided_positions.hpp"

namespace meniscus::client {

/// The treatment of frames that come faster than the server reconstructs them.
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

/// Rows of the options that streams of particles and publishers of surfaces have in common.
template <class Options, class Visit>
void upload_rows(const Visit& visit) {
    visit("waiting_limit", &Options::waiting_limit,
          {.help = "received frames that wait to be taken, at most; 0: no limit"});
    visit("policy", &Options::policy,
          {.help = "what the server does with frames that come faster than they are reconstructed"});
    visit("nth", &Options::nth, {.help = "one of this many frames is reconstructed", .when = "--policy every-nth"});
    visit("parts", &Options::parts,
          {.help = "streams that each send a part of every frame", .range = {.least = 1.0}, .when = "--run"});
    visit("part", &Options::part, {.help = "number of this one, counted from 0", .when = "--parts"});
    visit("run", &Options::run, {.help = "a number that the streams of all parts share, and no others; 0: at random"});
    visit("reconnect", &Options::reconnect,
          {.help = "time for which a server that is out of reach is tried again; 0: no retries", .unit = "s"});
    visit("route_check", &Options::route_check,
          {.help = "time between looks whether the session goes on with another server; 0: never", .unit = "s"});
}

struct StreamOptions {
    bool receive_meshes = true;
    int normal_bits = 8;  ///< 2 to 16, 0 for none
    NormalsBy normals_by = NormalsBy::server;
    /// Of the meshes. None: packed from a server on this machine (a loopback address, a Unix socket), entropy from
    /// others. The server answers in Draco where it has no other.
    std::optional<Codec> codec{};
    bool spray = false;  ///< whether the particles left out of the surface come beside the meshes
    /// The attributes of the session that the meshes carry, as in WatchOptions. None: their ranges alone come.
    std::vector<AttributeWish> attributes{};
    /// Received frames that wait for next() at most; push() waits beyond that many frames in flight or waiting.
    /// 0: no limit, for a caller that pushes everything first; frames then wait encoded, in memory.
    std::size_t waiting_limit = 0;
    UploadPolicy policy = UploadPolicy::every_frame;
    std::uint32_t nth = 1;  ///< of UploadPolicy::every_nth, at least 1
    /// Streams, of this and of other processes, that each send a part of every frame. All push the same indices and
    /// times, with the particles that each of them has, and say the same run, policy, nth and reconnect. Every stream
    /// gets the answers; meshes come to part 0 alone. Whatever ends one of the streams ends all of them.
    std::uint32_t parts = 1;
    std::uint32_t part = 0;  ///< the number of this one, counted from 0
    /// Names the frames that belong together, here and after a connection broke. 0: drawn at random, for a stream that
    /// sends whole frames. Parts need a number that is theirs alone: let part 0 draw one, and tell it to the others.
    std::uint64_t run = 0;
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
    /// Called at each attempt to go on after the connection broke, in a thread of the stream's own, which waits for it.
    /// So does the stream's destructor: it is not called once the stream has gone.
    ReconnectHandler on_reconnect{};
    /// When a stop is requested: as cancel(); while the stream is opened: ServerError (canceled), or a stream that has
    /// been canceled.
    std::stop_token stop{};

    /// The options that C, Python and files set by name.
    template <class Visit>
    static void rows(const Visit& visit) {
        using S = StreamOptions;
        visit("receive_meshes", &S::receive_meshes, {.help = "whether meshes come back", .option = "meshes"});
        visit("normal_bits", &S::normal_bits,
              {.help = "bits per component of the normals, 2 to 16; 0: no normals", .range = {.least = 0.0}});
        visit("normals_by", &S::normals_by,
              {.help = "maker of the normals: server, with normal_bits, or receiver, from the triangles: fewer bytes, "
                       "less exact"});
        visit("codec", &S::codec,
              {.help = "codec of the meshes: packed, the fastest, entropy, the smallest, or draco"});
        upload_rows<S>(visit);
    }
};

/// Uploads frames and receives their meshes, in order. Reads on a thread of its own, so that a caller that only pushes
/// is never blocked by meshes it has not asked for. push(), try_push() and finish() belong to one thread, next() and
/// try_next() to one (other) thread; cancel() and dropped() may be called from any.
///
/// push() and next() throw InvalidInput and LimitExceeded, as the server answered, or ServerError.
///
/// A frame's further arrays are sent if the session's settings name them. A stream that was opened by the session's id
/// alone, without `reconnect`, asks the server for the names once, in the first push() that brings arrays; a try_push()
/// before that, which does not wait, sends all.
class Stream {
public:
    Stream(Stream&&) noexcept;
    Stream& operator=(Stream&&) noexcept;
    ~Stream();  ///< cancels what is in flight; returns soon, even where the server reads nothing any more

    /// Sends one frame; blocks while the server does not take more, or is out of reach. `index` is greater than the one
    /// before. The particles are copied. Throws InvalidInput, too, for arrays whose lengths do not fit each other, and
    /// for one that the settings name which is missing, comes twice, or is neither float32 or uint8 of 1, 3 or 4
    /// components nor int32 or uint32 of 1; ServerError (canceled) after cancel(). The frame is then not pushed.
    void push(const ParticleFrame& frame, std::uint64_t index, double simulation_time);
    /// Likewise, of positions as a solver has them, float64 or within larger records: each number is rounded to the
    /// nearest float32, and the mesh is that of the rounded frame. levels: empty, or one per particle. Throws
    /// InvalidInput, too, for a number that is not finite or too large.
    void push(const StridedPositions& positions, std::uint64_t index, double simulation_time,
              std::span<const std::uint8_t> levels = {}, std::span<const ParticleArray> arrays = {});
    /// Likewise, but copies nothing: the stream takes the buffer's memory over. A frame that is not pushed stays in the
    /// buffer.
    void push(ParticleBuffer&& buffer, std::uint64_t index, double simulation_time);
    /// Likewise, of a vector that is no longer needed, as in push(std::move(positions), ...), and that is lost where
    /// the frame is not pushed. A template, so that {} is a ParticleFrame.
    template <class Floats>
    requires std::same_as<Floats, std::vector<float>>
    void push(Floats&& positions, std::uint64_t index, double simulation_time) {
        push(ParticleBuffer(std::forward<Floats>(positions)), index, simulation_time);
    }

    /// Sends one frame, as push() does, where that would not wait. Otherwise false, and nothing has been taken: neither
    /// the buffer nor the index.
    bool try_push(const ParticleFrame& frame, std::uint64_t index, double simulation_time);
    bool try_push(const StridedPositions& positions, std::uint64_t index, double simulation_time,
                  std::span<const std::uint8_t> levels = {}, std::span<const ParticleArray> arrays = {});
    bool try_push(ParticleBuffer&& buffer, std::uint64_t index, double simulation_time);

    /// Memory to write a frame into; what it holds is undefined. It comes back here when the server has the frame, so
    /// that a stream takes new memory for its first frames alone. Throws LimitExceeded for more particles than can be
    /// numbered, InvalidInput for an array of no components.
    ParticleBuffer next_buffer(std::size_t particles, bool with_levels = false,
                               const std::vector<ArrayForm>& arrays = {});

    /// No more frames will come; next() then ends after the last one.
    void finish();

    /// Waits for the next received frame; none when the stream has ended well, or after cancel().
    std::optional<ReceivedFrame> next();
    /// Likewise, no longer than the timeout.
    Next<ReceivedFrame> next(std::chrono::milliseconds timeout);
    /// Likewise, without waiting.
    Next<ReceivedFrame> try_next() { return next(std::chrono::milliseconds(0)); }

    /// Ends the stream at once, and a push() or next() that waits. Frames without an answer are lost, as are those that
    /// wait for next().
    void cancel();

    /// Frames dropped by the policy so far.
    std::uint64_t dropped() const;

private:
    friend class Client;
    friend class Publisher;
    friend class Session;
    class Impl;
    explicit Stream(std::shared_ptr<Impl> impl);
    void leave() noexcept;
    std::shared_ptr<Impl> impl_;  ///< shared with its threads
};

}  // namespace meniscus::client
