#include "meniscus/client/publisher.hpp"

#include <utility>

#include "connection/deadline.hpp"
#include "meniscus/client/surface_part.hpp"
#include "published_frame.hpp"
#include "stream_impl.hpp"

namespace meniscus::client {

namespace {

StreamOptions upload_options(const PublisherOptions& options) {
    return {.receive_meshes = false,
            .waiting_limit = options.waiting_limit,
            .policy = options.policy,
            .nth = options.nth,
            .parts = options.parts,
            .part = options.part,
            .run = options.run,
            .reconnect = options.reconnect,
            .route_check = options.route_check,
            .on_reconnect = options.on_reconnect,
            .stop = options.stop};
}

}  // namespace

Publisher::Publisher(std::shared_ptr<Connection> connection, const std::string& session_id,
                     const PublisherOptions& options, std::shared_ptr<MadeSessions> made)
    : coding_{.normal_bits = options.normal_bits, .codec = options.codec},
      wishes_{{.name = {}, .bits = options.attribute_bits}},
      impl_(Stream::Impl::open(std::move(connection), session_id, upload_options(options),
                               Stream::Impl::Uploads::bricks, std::move(made))) {}

Publisher::Publisher(Publisher&&) noexcept = default;
Publisher& Publisher::operator=(Publisher&& other) noexcept {
    if (this == &other) return *this;
    if (impl_) impl_->leave();
    coding_ = std::move(other.coding_);
    wishes_ = std::move(other.wishes_);
    impl_ = std::move(other.impl_);
    return *this;
}
Publisher::~Publisher() {
    if (impl_) impl_->leave();
}

void Publisher::push(const Mesh& mesh, const Statistics& statistics, std::uint64_t index, double simulation_time,
                     const BrickBox& own) {
    push(encode_own(mesh, statistics, index, simulation_time, own, coding_, wishes_));
}

void Publisher::push(const ReceivedFrame& frame) {
    impl_->push(frame.index, Stream::Impl::WhenFull::wait, false,
                [&](BytePool& pool, const NamedArrays&) { return published_frame(frame, pool); });
}

void Publisher::finish() {
    impl_->finish();
}

std::optional<ReceivedFrame> Publisher::next() {
    return impl_->next(std::nullopt).frame;
}

Next<ReceivedFrame> Publisher::next(std::chrono::milliseconds timeout) {
    return impl_->next(deadline_after<std::chrono::steady_clock>(timeout));
}

void Publisher::cancel() {
    impl_->cancel();
}

std::uint64_t Publisher::dropped() const {
    return impl_->dropped();
}

}  // namespace meniscus::client
