// A session's watchers, and the newest frame in every form that one of them has wished for.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "sessions/encoded_frame.hpp"
#include "sessions/particle_messages.hpp"
#include "sessions/watch.hpp"

namespace meniscus::server {

/// A frame's meshes by their format, each encoded once.
using Encodings = std::map<MeshFormat, std::shared_ptr<const EncodedFrame>>;

/// Thread-safe. A frame that is published goes to all watchers that wish for its form, and to each that comes later.
class Watchers {
public:
    struct Progress {
        std::uint32_t watchers = 0;
        std::uint64_t frames_skipped = 0;  ///< over all watchers, those that have gone included
        Watch::Clock::duration lag{};      ///< of the watcher that lags most
    };

    /// Returns whether the newest frame was there in the form that the watcher wishes for, and is on its way to it.
    bool add(const std::shared_ptr<Watch>& watch);
    void remove(const std::shared_ptr<Watch>& watch);

    std::size_t count() const;
    std::vector<std::shared_ptr<Watch>> list() const;
    Progress progress() const;

    // Particles.

    /// Another frame's particles are about to be published.
    void forget_particles();
    /// A limit of particles that a watcher wishes for and nobody has published.
    std::optional<std::uint64_t> unpublished_particles() const;
    void publish(std::uint64_t max_particles, const std::shared_ptr<const ParticleMessages>& particles);

    // Meshes.

    /// Another frame's meshes are about to be published. Returns those of the frame before.
    Encodings replace_meshes();
    /// Whether a watcher wishes for meshes of this finest level.
    bool wish_for_level(int max_level) const;
    /// A format that a watcher wishes for and nobody has published, of those whose finest level is there.
    std::optional<MeshFormat> unpublished_format(const std::function<bool(int max_level)>& is_there) const;
    void publish(const MeshFormat& format, const std::shared_ptr<const EncodedFrame>& frame);
    /// None if it was not published.
    std::shared_ptr<const EncodedFrame> published(const MeshFormat& format) const;

private:
    mutable std::mutex mutex_;  ///< for what follows
    std::vector<std::shared_ptr<Watch>> watches_;
    std::uint64_t skipped_by_the_gone_ = 0;
    Encodings meshes_;
    std::map<std::uint64_t, std::shared_ptr<const ParticleMessages>> particles_;  ///< by max_particles
};

}  // namespace meniscus::server
