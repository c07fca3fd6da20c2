// The inside of a ParticleWatcher.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "connection/connection.hpp"
#include "meniscus/client/client.hpp"
#include "receiving/particle_receiver.hpp"
#include "watch_call.hpp"

namespace meniscus::client {

class ParticleWatcher::Impl {
public:
    Impl(const std::shared_ptr<Connection>& connection, const std::string& session_id, std::uint64_t max_particles,
         std::chrono::milliseconds reconnect);

    std::optional<ReceivedParticles> next() { return call_.next(); }
    void cancel() { call_.cancel(); }

private:
    WatchCall<v1::WatchParticlesResponse, ParticleReceiver> call_;
};

}  // namespace meniscus::client
