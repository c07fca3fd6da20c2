#include <utility>

#include "brick_changes.hpp"
#include "codec_order.hpp"
#include "conversion/attribute_conversion.hpp"
#include "conversion/settings_conversion.hpp"
#include "watcher_impl.hpp"

namespace meniscus::client {

namespace {

v1::WatchRequest request_of(const std::string& session_id, const WatchOptions& options) {
    v1::WatchRequest request;
    request.set_session_id(session_id);
    request.set_normal_bits(static_cast<std::uint32_t>(asked_normal_bits(options.normals_by, options.normal_bits)));
    *request.mutable_attributes() = conversion::to_wire(std::span(options.attributes));
    if (options.position_bits) request.set_position_bits(static_cast<std::uint32_t>(*options.position_bits));
    request.set_max_level(static_cast<std::uint32_t>(options.max_level));
    if (options.region) *request.mutable_region() = conversion::to_wire(*options.region);
    request.set_bytes_per_second(options.bytes_per_second);
    request.set_with_spray(options.spray);
    if (options.viewpoint) {
        request.mutable_viewpoint()->set_x((*options.viewpoint)[0]);
        request.mutable_viewpoint()->set_y((*options.viewpoint)[1]);
        request.mutable_viewpoint()->set_z((*options.viewpoint)[2]);
    }
    return request;
}

}  // namespace

Watcher::Impl::Impl(const std::shared_ptr<Connection>& connection, const std::string& session_id,
                    const WatchOptions& options)
    : normals_by_(options.normals_by),
      call_(connection, session_id,
            {.patience = options.reconnect,
             .route_check = options.route_check,
             .on_reconnect = options.on_reconnect,
             .stop = options.stop},
            [&connection = *connection, request = request_of(session_id, options), codec = options.codec,
             stop = options.stop](grpc::ClientContext& context) mutable {
                *request.mutable_codecs() = codec_order(connection, codec, stop);
                return connection.surfaces->Watch(&context, request);
            }) {}

std::optional<ReceivedFrame> Watcher::Impl::receive() {
    auto frame = call_.next();
    if (frame) {
        find_changes(shown_bricks_, *frame);
        shown_bricks_ = frame->bricks;
        frame->normals_by = normals_by_;
    }
    return frame;
}

Watcher::Watcher(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Watcher::Watcher(Watcher&&) noexcept = default;
Watcher& Watcher::operator=(Watcher&&) noexcept = default;
Watcher::~Watcher() = default;

std::optional<ReceivedFrame> Watcher::next() {
    return impl_->next();
}

Next<ReceivedFrame> Watcher::next(std::chrono::milliseconds timeout) {
    return impl_->next(timeout);
}

void Watcher::cancel() {
    impl_->cancel();
}

std::string Watcher::end_reason() const {
    return impl_->end_reason();
}

}  // namespace meniscus::client
