// The inside of a Watcher.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "connection.hpp"
#include "frame_receiver.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::client {

class Watcher::Impl {
public:
    Impl(std::shared_ptr<Connection> connection, const std::string& session_id, int normal_bits);
    ~Impl();
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    std::optional<ReceivedFrame> next();
    void cancel();

private:
    /// The server has nothing more to send: throws, unless that is well.
    void end();

    const std::shared_ptr<Connection> connection_;
    grpc::ClientContext context_;
    std::unique_ptr<grpc::ClientReader<v1::WatchResponse>> call_;
    FrameReceiver receiver_{true};
    bool ended_ = false;
    std::atomic<bool> canceled_{false};
};

}  // namespace meniscus::client
