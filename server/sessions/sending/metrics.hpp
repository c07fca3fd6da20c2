// The reports of the service to its metrics.
#pragma once

#include <cstdint>
#include <string_view>

#include "sessions/sending/dropped_frame.hpp"
#include "sessions/sending/frame_statistics.hpp"

namespace meniscus::server {

/// Called once per frame, message or call, from any thread. This one counts nothing.
class Metrics {
public:
    enum class Receiver : std::uint8_t { simulator, watcher, recording_reader };

    /// A method of gRPC, in the words that dashboards of gRPC know.
    struct Method {
        std::string_view type = {};     ///< "unary", "client_stream", "server_stream" or "bidi_stream"
        std::string_view service = {};  ///< with its package, such as "meniscus.v1.SurfaceService"
        std::string_view name = {};     ///< such as "Watch"
    };

    Metrics() = default;
    virtual ~Metrics() = default;
    Metrics(const Metrics&) = delete;
    Metrics& operator=(const Metrics&) = delete;

    /// The last byte of a frame has come in.
    virtual void frame_received(std::uint64_t /*bytes*/) {}
    virtual void frame_dropped(DropReason /*reason*/) {}
    /// Reconstructed, and encoded for the simulator if it wants meshes.
    virtual void frame_finished(const FrameStatistics& /*statistics*/) {}
    /// In its place for a surface that was made elsewhere, which is there for watchers.
    virtual void surface_finished(const FrameStatistics& /*statistics*/) {}
    /// Bytes of one message. Takes no lock.
    virtual void message_sent(Receiver /*to*/, std::uint64_t /*bytes*/) {}
    /// A watcher had not taken the frame before a newer one replaced it.
    virtual void frame_skipped() {}
    /// A watcher has taken the end of a frame; seconds since the last byte of that frame had come in.
    virtual void watcher_lag(double /*seconds*/) {}
    /// A call has come in; call_ended() follows.
    virtual void call_started(const Method& /*method*/) {}
    /// code: its status, such as "InvalidArgument"; seconds: since it came in.
    virtual void call_ended(const Method& /*method*/, std::string_view /*code*/, double /*seconds*/) {}
    /// A call has been refused. reason: a word; name: of the caller's token, empty where there is none.
    virtual void refused(std::string_view /*reason*/, std::string_view /*name*/) {}
};

constexpr std::string_view name_of(Metrics::Receiver receiver) {
    switch (receiver) {
        case Metrics::Receiver::simulator:
            return "simulator";
        case Metrics::Receiver::watcher:
            return "watcher";
        case Metrics::Receiver::recording_reader:
            return "recording_reader";
    }
    return {};
}

}  // namespace meniscus::server
