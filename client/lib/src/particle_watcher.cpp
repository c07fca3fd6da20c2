#include <utility>

#include "error_mapping.hpp"
#include "particle_watcher_impl.hpp"

namespace meniscus::client {

ParticleWatcher::Impl::Impl(std::shared_ptr<Connection> connection, const std::string& session_id, std::uint64_t max_particles)
    : connection_(std::move(connection)) {
    connection_->add_metadata(context_, session_id);
    v1::WatchParticlesRequest request;
    request.set_session_id(session_id);
    request.set_max_particles(max_particles);
    reader_ = connection_->surfaces->WatchParticles(&context_, request);
    // The server answers, with metadata, once it has the watcher: no frame from here on is missed.
    reader_->WaitForInitialMetadata();
}

ParticleWatcher::Impl::~Impl() {
    if (ended_) return;
    cancel();
    v1::WatchParticlesResponse ignored;
    while (reader_->Read(&ignored)) {
    }
    reader_->Finish();
}

std::optional<ReceivedParticles> ParticleWatcher::Impl::next() {
    if (ended_) return std::nullopt;
    v1::WatchParticlesResponse response;
    while (reader_->Read(&response))
        if (auto particles = receiver_.take(response)) return particles;
    ended_ = true;
    const grpc::Status status = reader_->Finish();
    if (canceled_) return std::nullopt;
    require_ok(status, connection_->address);
    receiver_.end_of_stream();
    return std::nullopt;
}

void ParticleWatcher::Impl::cancel() {
    canceled_ = true;
    context_.TryCancel();
}

ParticleFrame ReceivedParticles::view() const {
    return {.positions = {}, .quantized = quantized, .quantization_box = quantization_box, .levels = levels};
}

ParticleWatcher::ParticleWatcher(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ParticleWatcher::ParticleWatcher(ParticleWatcher&&) noexcept = default;
ParticleWatcher& ParticleWatcher::operator=(ParticleWatcher&&) noexcept = default;
ParticleWatcher::~ParticleWatcher() = default;

std::optional<ReceivedParticles> ParticleWatcher::next() {
    return impl_->next();
}

void ParticleWatcher::cancel() {
    impl_->cancel();
}

}  // namespace meniscus::client
