// The inside of a RecordingReader.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "connection/connection.hpp"
#include "limited_wait.hpp"
#include "meniscus/client/client.hpp"
#include "receiving/frame_receiver.hpp"

namespace meniscus::client {

class RecordingReader::Impl {
public:
    Impl(std::shared_ptr<Connection> connection, const std::string& session_id, std::uint32_t number,
         const ReadOptions& options);
    ~Impl();
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    std::optional<ReceivedFrame> next() {
        if (canceled_) return std::nullopt;
        return wait_.next();
    }
    Next<ReceivedFrame> next(std::chrono::milliseconds timeout) {
        if (canceled_) return {.ended = true};
        return wait_.next(timeout);
    }
    void cancel();

private:
    std::optional<ReceivedFrame> receive();

    const std::shared_ptr<Connection> connection_;
    const NormalsBy normals_by_;
    grpc::ClientContext context_;
    std::unique_ptr<grpc::ClientReader<v1::WatchResponse>> reader_;
    FrameReceiver receiver_{true};
    bool ended_ = false;
    std::atomic<bool> canceled_{false};
    LimitedWait<ReceivedFrame> wait_{[this] { return receive(); }};
    std::optional<std::stop_callback<std::function<void()>>> on_stop_;
};

}  // namespace meniscus::client
