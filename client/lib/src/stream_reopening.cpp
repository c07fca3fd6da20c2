// How a stream goes on after its call broke: another call, and the session again where the server has lost it.
#include <string>
#include <utility>

#include "call_end.hpp"
#include "error_mapping.hpp"
#include "reconnecting.hpp"
#include "session_look.hpp"
#include "stream_impl.hpp"

namespace meniscus::client {

bool Stream::Impl::is_worth_another_call(const grpc::Status& status, const UploadCall& call) const {
    // The call came to another server than the one that had just created the session.
    const bool astray = status.error_code() == grpc::StatusCode::NOT_FOUND && ended_by(call.context()) != created_by_;
    if (!astray && !can_reconnect_after(status, call.context())) return false;
    const std::lock_guard lock(mutex_);
    return resumes() && !left_;
}

bool Stream::Impl::wait_for_use(const grpc::Status& status) {
    if (!resumes()) require_ok(status, connection_->address);
    std::unique_lock lock(mutex_);
    call_.reset();
    // Other parts of the frames are ended where one stays away.
    if (options_.parts > 1) return !left_;
    changed_.wait(lock, [&] { return left_ || finished_ || !unanswered_.empty(); });
    return !left_ && !unanswered_.empty();
}

std::shared_ptr<UploadCall> Stream::Impl::reopen(grpc::Status status) {
    if (!broken_at_) {
        broken_at_ = Clock::now();
        backoff_.reset();
        attempts_ = 0;
    }
    broken_reason_ = status.error_message();
    std::unique_lock lock(mutex_);
    call_.reset();
    const auto deadline = *broken_at_ + options_.reconnect;
    for (;;) {
        const auto attempt_at = Clock::now() + backoff_.next();
        if (attempt_at >= deadline)
            throw ServerError(
                "the server at " + connection_->address + " has not been available for " +
                    std::to_string(std::chrono::duration_cast<std::chrono::seconds>(options_.reconnect).count()) +
                    " s (" + status.error_message() + "): frame " +
                    (unanswered_.empty() ? "none" : std::to_string(unanswered_.front()->index)) +
                    " is the first without an answer",
                ErrorCode::unavailable, "UNAVAILABLE");
        if (changed_.wait_until(lock, attempt_at, [&] { return left_; })) return nullptr;
        const auto creating = std::make_shared<grpc::ClientContext>();
        creating_ = creating;
        lock.unlock();
        ++attempts_;
        report(false, deadline);
        grpc::Status created = create_session(*creating, deadline);
        std::shared_ptr<UploadCall> call;
        if (created.ok()) {
            created_by_ = ended_by(*creating);
            call = open_call(true);
            connecting_ = true;
        }
        lock.lock();
        creating_.reset();
        if (left_) {
            if (call) call->cancel();
            return call;
        }
        if (call) {
            call_ = call;
            sent_ = 0;
            half_closed_ = false;
            draining_ = false;
            moving_ = false;
            instance_.clear();
            changed_.notify_all();
            return call;
        }
        // A server that is full, of another's sessions perhaps, may have room later.
        const bool full = created.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED;
        if (!full && !can_reconnect_after(created, *creating)) require_ok(created, connection_->address);
        // A wait that was in vain says less than what was before.
        if (created.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED) continue;
        status = std::move(created);
        broken_reason_ = status.error_message();
    }
}

grpc::Status Stream::Impl::create_session(grpc::ClientContext& context, Clock::time_point give_up_at) const {
    connection_->add_metadata(context, session_.id());
    wait_for_connection(context, give_up_at);
    v1::CreateSessionResponse response;
    grpc::Status status = connection_->sessions->CreateSession(&context, session_, &response);
    if (status.ok() && made_) made_->note(response);
    return status;
}

void Stream::Impl::report(bool connected, Clock::time_point give_up_at) {
    {
        const std::lock_guard lock(mutex_);
        if (left_) return;
        reporting_ = true;
    }
    report_reconnecting(
        options_.on_reconnect,
        {.attempt = attempts_, .connected = connected, .reason = broken_reason_, .left = time_left(give_up_at)});
    const std::lock_guard lock(mutex_);
    reporting_ = false;
    stopped_.notify_all();
}

}  // namespace meniscus::client
