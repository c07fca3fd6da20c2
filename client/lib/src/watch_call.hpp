// A watcher's call, which is made again when it breaks.
#pragma once

#include <grpcpp/support/sync_stream.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "backoff.hpp"
#include "call_end.hpp"
#include "connection/connection.hpp"
#include "error_mapping.hpp"

namespace meniscus::client {

/// Receiver: puts the responses of one call together to frames, which have an index and a run.
template <class Response, class Receiver>
class WatchCall {
public:
    using Frame = typename decltype(std::declval<Receiver>().take(std::declval<Response>()))::value_type;
    using Reader = std::unique_ptr<grpc::ClientReader<Response>>;

    /// patience: for how long a call that broke is made again. start: makes it.
    WatchCall(std::shared_ptr<Connection> connection, std::string session_id, std::chrono::milliseconds patience,
              std::function<Reader(grpc::ClientContext&)> start)
        : connection_(std::move(connection)),
          session_id_(std::move(session_id)),
          patience_(patience),
          start_(std::move(start)) {
        open();
    }
    ~WatchCall() {
        if (ended_) return;
        cancel();
        Response ignored;
        while (call_->reader->Read(&ignored)) {
        }
        call_->reader->Finish();
    }
    WatchCall(const WatchCall&) = delete;
    WatchCall& operator=(const WatchCall&) = delete;

    /// The next frame that has not been returned before; none when the session has ended. Throws what the call ended
    /// with.
    std::optional<Frame> next() {
        while (!ended_) {
            auto frame = receive();
            if (!frame) {
                const grpc::Status status = call_->reader->Finish();
                ended_ = true;
                if (!try_again(status)) return std::nullopt;
                open();
                ended_ = false;
                continue;
            }
            backoff_.reset();
            if (was_shown(*frame)) continue;
            shown_run_ = frame->run_id;
            shown_index_ = frame->index;
            return frame;
        }
        return std::nullopt;
    }

    /// From any thread: next() then returns none.
    void cancel() {
        const std::lock_guard lock(mutex_);
        canceled_ = true;
        call_->context.TryCancel();
        canceled_now_.notify_all();
    }

private:
    using Clock = std::chrono::steady_clock;

    struct Call {
        grpc::ClientContext context;
        Reader reader;
        Receiver receiver;
    };

    void open() {
        auto call = std::make_unique<Call>();
        connection_->add_metadata(call->context, session_id_);
        {
            const std::lock_guard lock(mutex_);
            call_ = std::move(call);
            if (canceled_) call_->context.TryCancel();
        }
        call_->reader = start_(call_->context);
        // The server answers, with metadata, once it has the watcher: no frame from here on is missed.
        call_->reader->WaitForInitialMetadata();
        if (!call_->context.GetServerInitialMetadata().contains("x-session-id"))
            return;  // refused; a proxy may add its own
        had_session_ = true;
        broken_since_.reset();
    }

    /// The next frame of this call; none when the call has nothing more.
    std::optional<Frame> receive() {
        Response response;
        while (call_->reader->Read(&response))
            if (auto frame = call_->receiver.take(response)) return frame;
        return std::nullopt;
    }

    /// Of an earlier call: a run's frames go on where they stopped.
    bool was_shown(const Frame& frame) const {
        return frame.run_id != 0 && shown_index_ && frame.run_id == shown_run_ && frame.index <= *shown_index_;
    }

    /// After a call's end: whether there is another one. Throws what the call ended with, unless that is well.
    bool try_again(const grpc::Status& status) {
        if (is_canceled()) return false;
        if (status.ok()) {
            call_->receiver.end_of_stream();
            return false;
        }
        const auto now = Clock::now();
        if (!broken_since_) broken_since_ = now;
        const auto wait = backoff_.next();
        if (!may_come_back(status) || now + wait - *broken_since_ >= patience_)
            require_ok(status, connection_->address);
        std::unique_lock lock(mutex_);
        return !canceled_now_.wait_for(lock, wait, [&] { return canceled_; });
    }

    /// A server that was restarted, or follows one that has gone, has no session yet: the simulator creates it again.
    bool may_come_back(const grpc::Status& status) const {
        return may_go_on(status, call_->context) ||
               (status.error_code() == grpc::StatusCode::NOT_FOUND && had_session_);
    }

    bool is_canceled() {
        const std::lock_guard lock(mutex_);
        return canceled_;
    }

    const std::shared_ptr<Connection> connection_;
    const std::string session_id_;
    const std::chrono::milliseconds patience_;
    const std::function<Reader(grpc::ClientContext&)> start_;
    bool ended_ = false;
    bool had_session_ = false;
    std::optional<Clock::time_point> broken_since_;
    Backoff backoff_;
    std::uint64_t shown_run_ = 0;
    std::optional<std::uint64_t> shown_index_;

    std::mutex mutex_;  ///< for what follows, as cancel() comes from other threads; call_ is changed with it held
    std::condition_variable canceled_now_;
    std::unique_ptr<Call> call_;
    bool canceled_ = false;
};

}  // namespace meniscus::client
