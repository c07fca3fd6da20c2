// The inside of a Watcher.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "backoff.hpp"
#include "connection.hpp"
#include "frame_receiver.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::client {

class Watcher::Impl {
public:
    Impl(std::shared_ptr<Connection> connection, const std::string& session_id, const WatchOptions& options);
    ~Impl();
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    std::optional<ReceivedFrame> next();
    void cancel();

private:
    using Clock = std::chrono::steady_clock;

    /// One call; another follows when it breaks.
    struct Call {
        grpc::ClientContext context;
        std::unique_ptr<grpc::ClientReader<v1::WatchResponse>> reader;
        FrameReceiver receiver{true, true};
    };

    void open();
    /// The next frame of this call; none when the call has nothing more.
    std::optional<ReceivedFrame> receive();
    /// Of an earlier call: a run's frames go on where they stopped.
    bool was_shown(const ReceivedFrame& frame) const;
    /// After a call's end: whether there is another one. Throws what the call ended with, unless that is well.
    bool try_again(const grpc::Status& status);
    bool may_come_back(const grpc::Status& status) const;
    bool is_canceled();

    const std::shared_ptr<Connection> connection_;
    const WatchOptions options_;
    const std::string session_id_;
    v1::WatchRequest request_;
    bool ended_ = false;
    bool had_session_ = false;
    std::optional<Clock::time_point> broken_since_;
    Backoff backoff_;
    std::uint64_t shown_run_ = 0;
    std::optional<std::uint64_t> shown_index_;
    std::vector<std::shared_ptr<const EncodedBrick>> shown_bricks_;

    std::mutex mutex_;  ///< for what follows, as cancel() comes from other threads; call_ is changed with it held
    std::condition_variable canceled_now_;
    std::unique_ptr<Call> call_;
    bool canceled_ = false;
};

}  // namespace meniscus::client
