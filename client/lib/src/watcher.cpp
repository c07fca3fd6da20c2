#include <utility>

#include "brick_changes.hpp"
#include "conversion/settings_conversion.hpp"
#include "error_mapping.hpp"
#include "watcher_impl.hpp"

namespace meniscus::client {

namespace {

v1::WatchRequest request_of(const std::string& session_id, const WatchOptions& options) {
    v1::WatchRequest request;
    request.set_session_id(session_id);
    request.set_normal_bits(static_cast<std::uint32_t>(options.normal_bits));
    if (options.position_bits) request.set_position_bits(static_cast<std::uint32_t>(*options.position_bits));
    request.set_max_level(static_cast<std::uint32_t>(options.max_level));
    if (options.region) *request.mutable_region() = conversion::to_wire(*options.region);
    request.set_bytes_per_second(options.bytes_per_second);
    if (options.viewpoint) {
        request.mutable_viewpoint()->set_x((*options.viewpoint)[0]);
        request.mutable_viewpoint()->set_y((*options.viewpoint)[1]);
        request.mutable_viewpoint()->set_z((*options.viewpoint)[2]);
    }
    return request;
}

}  // namespace

Watcher::Impl::Impl(std::shared_ptr<Connection> connection, const std::string& session_id, const WatchOptions& options)
    : connection_(std::move(connection)),
      options_(options),
      session_id_(session_id),
      request_(request_of(session_id, options)) {
    open();
}

Watcher::Impl::~Impl() {
    if (ended_) return;
    cancel();
    v1::WatchResponse ignored;
    while (call_->reader->Read(&ignored)) {
    }
    call_->reader->Finish();
}

void Watcher::Impl::open() {
    auto call = std::make_unique<Call>();
    connection_->add_metadata(call->context, session_id_);
    {
        const std::lock_guard lock(mutex_);
        call_ = std::move(call);
        if (canceled_) call_->context.TryCancel();
    }
    call_->reader = connection_->surfaces->Watch(&call_->context, request_);
    // The server answers, with metadata, once it has the watcher: no mesh from here on is missed.
    call_->reader->WaitForInitialMetadata();
    if (call_->context.GetServerInitialMetadata().empty()) return;  // refused
    had_session_ = true;
    broken_since_.reset();
}

std::optional<ReceivedFrame> Watcher::Impl::next() {
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
        find_changes(shown_bricks_, *frame);
        shown_bricks_ = frame->bricks;
        return frame;
    }
    return std::nullopt;
}

std::optional<ReceivedFrame> Watcher::Impl::receive() {
    v1::WatchResponse response;
    while (call_->reader->Read(&response))
        if (auto frame = call_->receiver.take(response)) return frame;
    return std::nullopt;
}

bool Watcher::Impl::was_shown(const ReceivedFrame& frame) const {
    return frame.run_id != 0 && shown_index_ && frame.run_id == shown_run_ && frame.index <= *shown_index_;
}

bool Watcher::Impl::try_again(const grpc::Status& status) {
    if (is_canceled()) return false;
    if (status.ok()) {
        call_->receiver.end_of_stream();
        return false;
    }
    const auto now = Clock::now();
    if (!broken_since_) broken_since_ = now;
    const auto wait = backoff_.next();
    if (!may_come_back(status) || now + wait - *broken_since_ >= options_.reconnect)
        require_ok(status, connection_->address);
    std::unique_lock lock(mutex_);
    return !canceled_now_.wait_for(lock, wait, [&] { return canceled_; });
}

/// A server that was restarted has lost its sessions: the simulator creates them again.
bool Watcher::Impl::may_come_back(const grpc::Status& status) const {
    return status.error_code() == grpc::StatusCode::UNAVAILABLE ||
           (status.error_code() == grpc::StatusCode::NOT_FOUND && had_session_);
}

bool Watcher::Impl::is_canceled() {
    const std::lock_guard lock(mutex_);
    return canceled_;
}

void Watcher::Impl::cancel() {
    const std::lock_guard lock(mutex_);
    canceled_ = true;
    call_->context.TryCancel();
    canceled_now_.notify_all();
}

Watcher::Watcher(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Watcher::Watcher(Watcher&&) noexcept = default;
Watcher& Watcher::operator=(Watcher&&) noexcept = default;
Watcher::~Watcher() = default;

std::optional<ReceivedFrame> Watcher::next() {
    return impl_->next();
}

void Watcher::cancel() {
    impl_->cancel();
}

}  // namespace meniscus::client
