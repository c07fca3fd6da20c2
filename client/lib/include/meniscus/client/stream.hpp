// A simulator's stream: particle frames out, meshes in.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "meniscus/client/received_frame.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus::client {

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
    friend class Session;
    class Impl;
    explicit Stream(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::client
