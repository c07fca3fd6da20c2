// The inside of a Watcher.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "connection/connection.hpp"
#include "limited_wait.hpp"
#include "meniscus/client/client.hpp"
#include "receiving/frame_receiver.hpp"
#include "watch_call.hpp"

namespace meniscus::client {

class Watcher::Impl {
public:
    Impl(const std::shared_ptr<Connection>& connection, const std::string& session_id, const WatchOptions& options);
    ~Impl() { call_.cancel(); }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    std::optional<ReceivedFrame> next() {
        if (call_.is_canceled()) return std::nullopt;
        return wait_.next();
    }
    Next<ReceivedFrame> next(std::chrono::milliseconds timeout) {
        if (call_.is_canceled()) return {.ended = true};
        return wait_.next(timeout);
    }
    void cancel() { call_.cancel(); }
    std::string end_reason() { return call_.end_reason(); }

private:
    struct Receiver : FrameReceiver {
        Receiver() : FrameReceiver(true, true) {}
    };

    std::optional<ReceivedFrame> receive();

    const NormalsBy normals_by_;
    WatchCall<v1::WatchResponse, Receiver> call_;
    std::vector<std::shared_ptr<const EncodedBrick>> shown_bricks_;
    LimitedWait<ReceivedFrame> wait_{[this] { return receive(); }};
};

}  // namespace meniscus::client
