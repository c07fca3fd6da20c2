// The inside of a ParticleWatcher.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "connection/connection.hpp"
#include "limited_wait.hpp"
#include "meniscus/client/client.hpp"
#include "receiving/particle_receiver.hpp"
#include "watch_call.hpp"

namespace meniscus::client {

class ParticleWatcher::Impl {
public:
    Impl(const std::shared_ptr<Connection>& connection, const std::string& session_id,
         const ParticleWatchOptions& options);
    ~Impl() { call_.cancel(); }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    std::optional<ReceivedParticles> next() {
        if (call_.is_canceled()) return std::nullopt;
        return wait_.next();
    }
    Next<ReceivedParticles> next(std::chrono::milliseconds timeout) {
        if (call_.is_canceled()) return {.ended = true};
        return wait_.next(timeout);
    }
    void cancel() { call_.cancel(); }

private:
    WatchCall<v1::WatchParticlesResponse, ParticleReceiver> call_;
    LimitedWait<ReceivedParticles> wait_{[this] { return call_.next(); }};
};

}  // namespace meniscus::client
