// The meshes of somebody else's session.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/client/next.hpp"
#include "meniscus/client/normals_by.hpp"
#include "meniscus/client/received_frame.hpp"
#include "meniscus/client/reconnect_event.hpp"
#include "meniscus/codec.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::client {

/// The options of a watcher of meshes. Watchers with equal max_level, position_bits, normal_bits, attributes and codec
/// cost the server one encode.
struct WatchOptions {
    int normal_bits = 8;  ///< 2 to 16, 0 for none
    NormalsBy normals_by = NormalsBy::server;
    std::optional<int> position_bits{};  ///< vertices lie on multiples of c / 2^position_bits, 2 to the mesh's
                                         ///< offset_bits; none: as reconstructed
    std::optional<Codec> codec{};  ///< as in StreamOptions; with bytes_per_second it is entropy where none is given
    int max_level = 3;             ///< finest level of grid, 1 to 3: below 3 the surface is coarser, and closed as ever
    std::optional<Box> region{};   ///< world units: only bricks that touch it; the mesh ends where they do
    /// The attributes of the session that the meshes carry; an empty name stands for all others. A float32 of 8 bits is
    /// rounded to one of 256 values.
    std::vector<AttributeWish> attributes{};
    bool spray = false;  ///< whether the particles left out of the surface come beside it: all, whatever the region
    std::uint64_t bytes_per_second = 0;                ///< in the mean: frames are skipped to keep it; 0: no limit
    std::optional<std::array<double, 3>> viewpoint{};  ///< world units: nearest bricks are sent first
    /// How long to try again after the connection breaks, the session moves to another server, or the server goes down,
    /// or comes back without the session, which its simulator then creates again. next() goes on with the first frame
    /// of a run that it has not returned before. 0: not at all.
    std::chrono::milliseconds reconnect{0};
    /// How often to look whether the session goes on with another server, as in StreamOptions. Only with `reconnect`.
    std::chrono::milliseconds route_check{2000};
    /// Called at each attempt to go on after the connection broke, in the thread that is in next(); once next(timeout)
    /// or try_next() was called: in a thread of the library's, which waits for it.
    ReconnectHandler on_reconnect{};
    std::stop_token stop{};  ///< when a stop is requested: as cancel()

    /// The options that C, Python and files set by name.
    template <class Visit>
    static void rows(const Visit& visit) {
        using W = WatchOptions;
        visit("max_level", &W::max_level,
              {.help = "finest level of grid, 1 to 3: a coarser surface, as closed", .range = {.least = 0.0}});
        visit("normal_bits", &W::normal_bits,
              {.help = "bits per component of the normals, 2 to 16; 0: no normals", .range = {.least = 0.0}});
        visit("normals_by", &W::normals_by,
              {.help = "maker of the normals: server, with normal_bits, or receiver, from the triangles: fewer bytes, "
                       "less exact"});
        visit("position_bits", &W::position_bits,
              {.help = "vertices lie on multiples of the cell size / 2^BITS, 2 or more"});
        visit("codec", &W::codec,
              {.help = "codec of the meshes: packed, the fastest, entropy, the smallest, or draco"});
        visit("region", &W::region, {.help = "only bricks that touch this box", .unit = "world units"});
        visit("spray", &W::spray, {.help = "whether the particles left out of the surface come beside it"});
        visit("bytes_per_second", &W::bytes_per_second,
              {.help = "bandwidth in the mean: frames are skipped to keep it; 0: no limit"});
        visit("viewpoint", &W::viewpoint, {.help = "the nearest bricks are sent first", .unit = "world units"});
        visit("reconnect", &W::reconnect,
              {.help = "time for which a broken connection or a restarting server is tried again; 0: no retries",
               .unit = "s"});
        visit("route_check", &W::route_check,
              {.help = "time between looks whether the session goes on with another server; 0: never", .unit = "s"});
    }
};

/// The form of a session's newest mesh; as in WatchOptions.
struct SnapshotOptions {
    int normal_bits = 8;
    NormalsBy normals_by = NormalsBy::server;
    std::optional<int> position_bits{};
    std::optional<Codec> codec{};
    int max_level = 3;
    std::vector<AttributeWish> attributes{};
    std::stop_token stop{};  ///< when a stop is requested: ServerError (canceled)

    template <class Visit>
    static void rows(const Visit& visit) {
        using S = SnapshotOptions;
        visit("max_level", &S::max_level,
              {.help = "finest level of grid, 1 to 3: a coarser surface, as closed", .range = {.least = 0.0}});
        visit("normal_bits", &S::normal_bits,
              {.help = "bits per component of the normals, 2 to 16; 0: no normals", .range = {.least = 0.0}});
        visit("normals_by", &S::normals_by,
              {.help = "maker of the normals: server, with normal_bits, or receiver, from the triangles: fewer bytes, "
                       "less exact"});
        visit("position_bits", &S::position_bits,
              {.help = "vertices lie on multiples of the cell size / 2^BITS, 2 or more"});
        visit("codec", &S::codec, {.help = "codec of the mesh: packed, the fastest, entropy, the smallest, or draco"});
    }
};

/// Receives a session's meshes, always the newest; frames that came while the caller was busy are skipped by the
/// server. All but cancel() belongs to one thread.
class Watcher {
public:
    Watcher(Watcher&&) noexcept;
    Watcher& operator=(Watcher&&) noexcept;
    ~Watcher();

    /// Waits for the next frame; none when the session has ended. Throws InvalidInput for an option out of range,
    /// LimitExceeded or ServerError, also when the server goes down.
    std::optional<ReceivedFrame> next();
    /// Likewise, no longer than the timeout. After a frame, the next one is received ahead.
    Next<ReceivedFrame> next(std::chrono::milliseconds timeout);
    /// Likewise, without waiting: for a loop with other things to do, such as drawing.
    Next<ReceivedFrame> try_next() { return next(std::chrono::milliseconds(0)); }
    /// From any thread: ends the call, and a next() that waits; it then returns none.
    void cancel();
    /// From any thread, once next() has returned none: why the session ended, such as "it was deleted". Empty: it has
    /// not ended, or the server is of an older version.
    std::string end_reason() const;

private:
    friend class Client;
    friend class Session;
    class Impl;
    explicit Watcher(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::client
