// The inside of a Watcher.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "connection/connection.hpp"
#include "meniscus/client/client.hpp"
#include "receiving/frame_receiver.hpp"
#include "watch_call.hpp"

namespace meniscus::client {

class Watcher::Impl {
public:
    Impl(const std::shared_ptr<Connection>& connection, const std::string& session_id, const WatchOptions& options);

    std::optional<ReceivedFrame> next();
    void cancel() { call_.cancel(); }

private:
    struct Receiver : FrameReceiver {
        Receiver() : FrameReceiver(true, true) {}
    };

    WatchCall<v1::WatchResponse, Receiver> call_;
    std::vector<std::shared_ptr<const EncodedBrick>> shown_bricks_;
};

}  // namespace meniscus::client
