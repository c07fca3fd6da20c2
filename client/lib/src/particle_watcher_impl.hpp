// The inside of a ParticleWatcher.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "connection.hpp"
#include "meniscus/client/client.hpp"
#include "particle_receiver.hpp"

namespace meniscus::client {

class ParticleWatcher::Impl {
public:
    Impl(std::shared_ptr<Connection> connection, const std::string& session_id, std::uint64_t max_particles);
    ~Impl();
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    std::optional<ReceivedParticles> next();
    void cancel();

private:
    const std::shared_ptr<Connection> connection_;
    grpc::ClientContext context_;
    std::unique_ptr<grpc::ClientReader<v1::WatchParticlesResponse>> reader_;
    ParticleReceiver receiver_;
    bool ended_ = false;
    std::atomic<bool> canceled_ = false;
};

}  // namespace meniscus::client
