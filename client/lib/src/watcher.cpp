#include <utility>

#include "error_mapping.hpp"
#include "watcher_impl.hpp"

namespace meniscus::client {

Watcher::Impl::Impl(std::shared_ptr<Connection> connection, const std::string& session_id, int normal_bits)
    : connection_(std::move(connection)) {
    connection_->add_metadata(context_, session_id);
    v1::WatchRequest request;
    request.set_session_id(session_id);
    request.set_normal_bits(static_cast<std::uint32_t>(normal_bits));
    call_ = connection_->surfaces->Watch(&context_, request);
    // The server answers once it has the watcher: no mesh from here on is missed.
    call_->WaitForInitialMetadata();
}

Watcher::Impl::~Impl() {
    if (ended_) return;
    context_.TryCancel();
    v1::WatchResponse ignored;
    while (call_->Read(&ignored)) {
    }
    call_->Finish();
}

std::optional<ReceivedFrame> Watcher::Impl::next() {
    v1::WatchResponse response;
    while (!ended_) {
        if (!call_->Read(&response)) {
            end();
            break;
        }
        if (auto frame = receiver_.take(response)) return frame;
    }
    return std::nullopt;
}

void Watcher::Impl::end() {
    ended_ = true;
    const grpc::Status status = call_->Finish();
    if (canceled_) return;
    require_ok(status, connection_->address);
    receiver_.end_of_stream();
}

void Watcher::Impl::cancel() {
    canceled_ = true;
    context_.TryCancel();
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
