// The particles of somebody else's session.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "meniscus/client/next.hpp"
#include "meniscus/client/reconnect_event.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::client {

/// Some or all of the particles of a frame. Their surface is the mesh of the frame with the same index and run.
struct ReceivedParticles {
    std::uint64_t index = 0;
    std::uint64_t run_id = 0;
    double simulation_time = 0.0;
    std::uint64_t frame_count = 0;  ///< particles of the frame
    std::uint64_t stride = 1;       ///< of those, every stride-th is here, beginning with the first
    double particle_radius = 0.0;   ///< of level 0, world units
    Box quantization_box;
    std::vector<std::uint16_t> quantized;  ///< x y z per particle: min + q (max - min) / 65535 of quantization_box
    std::vector<std::uint8_t> levels;      ///< empty, or one per particle

    /// Borrows from here.
    ParticleFrame view() const;
};

/// The options of a watcher of particles.
struct ParticleWatchOptions {
    /// The most particles of a frame that are sent: of more, only every k-th, by the smallest k that suffices. 0: all.
    std::uint64_t max_particles = 0;
    std::chrono::milliseconds reconnect{0};  ///< this and the following as in WatchOptions
    std::chrono::milliseconds route_check{2000};
    ReconnectHandler on_reconnect{};
    std::stop_token stop{};

    template <class Visit>
    static void rows(const Visit& visit) {
        using P = ParticleWatchOptions;
        visit("max_particles", &P::max_particles, {.help = "particles of a frame that are sent, at most; 0: all"});
        visit("reconnect", &P::reconnect,
              {.help = "time for which a broken connection or a restarting server is tried again; 0: no retries",
               .unit = "s"});
        visit("route_check", &P::route_check,
              {.help = "time between looks whether the session goes on with another server; 0: never", .unit = "s"});
    }
};

/// Receives a session's particles, always the newest; frames that came while the caller was busy are skipped by the
/// server. All but cancel() belongs to one thread.
class ParticleWatcher {
public:
    ParticleWatcher(ParticleWatcher&&) noexcept;
    ParticleWatcher& operator=(ParticleWatcher&&) noexcept;
    ~ParticleWatcher();

    /// Waits for the next frame; none when the session has ended. Throws LimitExceeded or ServerError, also when the
    /// server goes down.
    std::optional<ReceivedParticles> next();
    /// These three functions work as those of Watcher.
    Next<ReceivedParticles> next(std::chrono::milliseconds timeout);
    Next<ReceivedParticles> try_next() { return next(std::chrono::milliseconds(0)); }
    void cancel();

private:
    friend class Client;
    friend class Session;
    class Impl;
    explicit ParticleWatcher(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::client
