#include <utility>

#include "particle_watcher_impl.hpp"

namespace meniscus::client {

namespace {

v1::WatchParticlesRequest request_of(const std::string& session_id, std::uint64_t max_particles) {
    v1::WatchParticlesRequest request;
    request.set_session_id(session_id);
    request.set_max_particles(max_particles);
    return request;
}

}  // namespace

ParticleWatcher::Impl::Impl(const std::shared_ptr<Connection>& connection, const std::string& session_id,
                            const ParticleWatchOptions& options)
    : call_(connection, session_id,
            {.patience = options.reconnect,
             .route_check = options.route_check,
             .on_reconnect = options.on_reconnect,
             .stop = options.stop},
            [surfaces = connection->surfaces.get(), request = request_of(session_id, options.max_particles)](
                grpc::ClientContext& context) { return surfaces->WatchParticles(&context, request); }) {}

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

Next<ReceivedParticles> ParticleWatcher::next(std::chrono::milliseconds timeout) {
    return impl_->next(timeout);
}

void ParticleWatcher::cancel() {
    impl_->cancel();
}

}  // namespace meniscus::client
