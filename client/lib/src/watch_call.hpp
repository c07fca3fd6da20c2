// A watcher's call, which is made again when it breaks.
#pragma once

#include <grpcpp/support/sync_stream.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "backoff.hpp"
#include "call_end.hpp"
#include "connection/connection.hpp"
#include "connection/deadline.hpp"
#include "error_mapping.hpp"
#include "meniscus/client/reconnect_event.hpp"
#include "reconnecting.hpp"
#include "session_look.hpp"
#include "unary_call.hpp"

namespace meniscus::client {

/// The caller's wishes for a call beside its request.
struct WatchPersistence {
    std::chrono::milliseconds patience{0};     ///< for how long a call that broke is made again
    std::chrono::milliseconds route_check{0};  ///< how often to look, then, whether another server has the session by
                                               ///< now; 0: never
    ReconnectHandler on_reconnect{};
    std::stop_token stop{};  ///< as cancel()
};

/// Receiver: puts the responses of one call together to frames, which have an index and a run.
template <class Response, class Receiver>
class WatchCall {
public:
    using Frame = typename decltype(std::declval<Receiver>().take(std::declval<Response>()))::value_type;
    using Reader = std::unique_ptr<grpc::ClientReader<Response>>;

    /// start: makes the call.
    WatchCall(std::shared_ptr<Connection> connection, std::string session_id, WatchPersistence persistence,
              std::function<Reader(grpc::ClientContext&)> start)
        : connection_(std::move(connection)),
          session_id_(std::move(session_id)),
          persistence_(std::move(persistence)),
          start_(std::move(start)) {
        persistence_.patience = std::min(persistence_.patience, longest_wait);
        persistence_.route_check = std::min(persistence_.route_check, longest_wait);
        on_stop_.emplace(persistence_.stop, [this] { cancel(); });
        open();
        if (persistence_.patience.count() > 0 && persistence_.route_check.count() > 0)
            route_checker_ = std::thread([this] { check_route(); });
    }
    ~WatchCall() {
        on_stop_.reset();
        cancel();
        if (route_checker_.joinable()) route_checker_.join();
        if (ended_) return;
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
                grpc::Status status = finish();
                if (!find_again(std::move(status))) return std::nullopt;
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

    /// Cancels the calls, from any thread, as is_canceled(): a next() that waits then returns none.
    void cancel() {
        const std::lock_guard lock(mutex_);
        canceled_ = true;
        if (call_) call_->context.TryCancel();
        for (const auto& look : {finding_, checking_})
            if (look) look->TryCancel();
        canceled_now_.notify_all();
    }
    bool is_canceled() {
        const std::lock_guard lock(mutex_);
        return canceled_;
    }
    /// Of the session that has ended, in the server's words; empty before, and where the server has none. From any
    /// thread.
    std::string end_reason() {
        const std::lock_guard lock(mutex_);
        return end_reason_;
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
        late_ = !begin_in_time();
        if (!call_->context.GetServerInitialMetadata().contains("x-session-id"))
            return;  // refused; a proxy may add its own
        had_session_ = true;
        if (broken_since_ && attempts_ > 0) report(true);
        broken_since_.reset();
        attempts_ = 0;
        const std::lock_guard lock(mutex_);
        instance_ = accepted_by(call_->context);
    }

    /// Whether the server has answered in time; otherwise the call has ended.
    bool begin_in_time() {
        auto begun = std::async(std::launch::async, [this] {
            call_->reader = start_(call_->context);
            // The server answers, with metadata, once it has the watcher: no frame from here on is missed.
            call_->reader->WaitForInitialMetadata();
        });
        const bool in_time = begun.wait_until(deadline_after<Clock>(connection_->timeout)) == std::future_status::ready;
        if (!in_time) call_->context.TryCancel();
        begun.get();
        return in_time;
    }

    grpc::Status finish() {
        grpc::Status status = call_->reader->Finish();
        if (late_) status = not_answered(connection_->timeout);
        ended_ = true;
        const std::lock_guard lock(mutex_);
        instance_.clear();
        return status;
    }

    /// The next frame of this call; none when the call has nothing more.
    std::optional<Frame> receive() {
        Response response;
        while (call_->reader->Read(&response))
            if (auto frame = call_->receiver.take(response)) return frame;
        return std::nullopt;
    }

    /// Whether an earlier call has returned the frame: a run's frames go on where they stopped.
    bool was_shown(const Frame& frame) const {
        return frame.run_id != 0 && shown_index_ && frame.run_id == shown_run_ && frame.index <= *shown_index_;
    }

    /// After a call's end: waits for a server that has the session. False if there is nothing to go on with. Throws
    /// what the call ended with, unless that is well or another one may go on.
    bool find_again(grpc::Status status) {
        if (is_canceled()) return false;
        if (status.ok()) {
            call_->receiver.end_of_stream();
            const std::lock_guard lock(mutex_);
            end_reason_ = session_end_of(call_->context);
            return false;
        }
        if (!broken_since_) broken_since_ = Clock::now();
        const auto give_up_at = *broken_since_ + persistence_.patience;
        bool may_come_back = this->may_come_back(status, call_->context);
        bool reached = false;
        for (;;) {
            const auto attempt_at = Clock::now() + backoff_.next();
            if (!may_come_back || attempt_at >= give_up_at) require_ok(status, connection_->address);
            std::unique_lock lock(mutex_);
            if (canceled_now_.wait_until(lock, attempt_at, [&] { return canceled_; })) return false;
            const auto finding = finding_ = std::make_shared<grpc::ClientContext>();
            lock.unlock();
            ++attempts_;
            broken_reason_ = status.error_message();
            report(false);
            wait_for_connection(*finding, give_up_at);
            v1::Session session;
            grpc::Status found = get_session(*connection_, *finding, session_id_, session);
            if (found.ok()) return true;
            may_come_back = this->may_come_back(found, *finding);
            // The server is back, and its simulator will be in a moment.
            if (found.error_code() == grpc::StatusCode::NOT_FOUND && !std::exchange(reached, true)) backoff_.reset();
            // A wait that was in vain says less than what was before.
            if (found.error_code() != grpc::StatusCode::DEADLINE_EXCEEDED) status = std::move(found);
        }
    }

    /// A server that was restarted, or follows one that has gone, has no session yet: the simulator creates it again.
    bool may_come_back(const grpc::Status& status, const grpc::ClientContext& context) const {
        return can_reconnect_after(status, context) ||
               (status.error_code() == grpc::StatusCode::NOT_FOUND && had_session_);
    }

    /// The work of the thread that looks. A session whose simulator lost its connection while the servers behind a
    /// proxy changed goes on with another server, and the one that this call is on does not hear of it.
    void check_route() {
        std::unique_lock lock(mutex_);
        while (!canceled_now_.wait_for(lock, persistence_.route_check, [&] { return canceled_; })) {
            if (instance_.empty()) continue;
            const std::string instance = instance_;
            const auto checking = checking_ = std::make_shared<grpc::ClientContext>();
            lock.unlock();
            const bool elsewhere = is_elsewhere(instance, *checking);
            lock.lock();
            if (elsewhere && instance_ == instance) call_->context.TryCancel();
        }
    }

    /// Whether another server than this instance answers for the session, and has frames of it or awaits them.
    bool is_elsewhere(const std::string& instance, grpc::ClientContext& checking) const {
        wait_for_connection(checking, Clock::now() + persistence_.patience);
        v1::Session session;
        const bool there = get_session(*connection_, checking, session_id_, session).ok();
        const std::string other = ended_by(checking);
        return there && !other.empty() && other != instance && (session.uploading() || session.has_last_frame_index());
    }

    void report(bool connected) const {
        report_reconnecting(persistence_.on_reconnect, {.attempt = attempts_,
                                                        .connected = connected,
                                                        .reason = broken_reason_,
                                                        .left = time_left(*broken_since_ + persistence_.patience)});
    }

    const std::shared_ptr<Connection> connection_;
    const std::string session_id_;
    WatchPersistence persistence_;  ///< as it is from the constructor on
    const std::function<Reader(grpc::ClientContext&)> start_;
    bool ended_ = false;
    bool late_ = false;  ///< the call was not answered in time
    bool had_session_ = false;
    std::optional<Clock::time_point> broken_since_;
    unsigned attempts_ = 0;      ///< since then
    std::string broken_reason_;  ///< or why the attempt before was in vain
    Backoff backoff_;
    std::uint64_t shown_run_ = 0;
    std::optional<std::uint64_t> shown_index_;

    std::mutex mutex_;  ///< for what follows, as cancel() comes from other threads; call_ is changed with it held
    std::condition_variable canceled_now_;
    std::unique_ptr<Call> call_;
    std::string instance_;  ///< of the server that has accepted it; empty: none, or it has ended
    std::shared_ptr<grpc::ClientContext> finding_;   ///< of the call that looks for the session
    std::shared_ptr<grpc::ClientContext> checking_;  ///< likewise, of the other thread
    bool canceled_ = false;
    std::string end_reason_;

    std::thread route_checker_;
    std::optional<std::stop_callback<std::function<void()>>> on_stop_;
};

}  // namespace meniscus::client
