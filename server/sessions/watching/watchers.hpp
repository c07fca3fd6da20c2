// A session's watchers, and the newest frame in every form that one of them has asked for.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

#include "sessions/sending/encoded_frame.hpp"
#include "sessions/watching/particle_messages.hpp"
#include "sessions/watching/watch.hpp"

namespace meniscus::server {

/// A frame's meshes by their format, each encoded once.
using Encodings = std::map<MeshFormat, std::shared_ptr<const EncodedFrame>>;

/// Thread-safe. A frame that is published goes to all watchers that ask for its form, and to each that comes later. It
/// is forgotten once no watcher asks for that form any more. A watch that asks for one frame alone (a snapshot) is
/// here until it has that, and counts as no watcher.
class Watchers {
public:
    struct Progress {
        std::uint32_t watchers = 0;
        std::uint64_t frames_skipped = 0;  ///< over all watchers, those that have gone included
        Watch::Clock::duration lag{};      ///< of the watcher that lags most
    };

    /// Returns whether the newest frame was there in the form that the watcher asks for, and is on its way to it.
    bool add(const std::shared_ptr<Watch>& watch);
    void remove(const std::shared_ptr<Watch>& watch);

    std::size_t count() const;
    /// Snapshots that wait included.
    std::vector<std::shared_ptr<Watch>> list() const;
    Progress progress() const;

    // Particles.

    /// Particles of another frame with this number of them are about to be published.
    void forget_particles(std::uint64_t particle_count);
    /// Strides that watchers ask for and nobody has published.
    std::set<std::uint64_t> unpublished_strides() const;
    void publish(std::uint64_t stride, const std::shared_ptr<const ParticleMessages>& particles);

    // Meshes.

    enum class Keep : std::uint8_t { while_wanted, until_the_next_frame };

    /// Another frame's meshes are about to be published. Returns those of the frame before.
    Encodings replace_meshes();
    /// Whether a watcher asks for meshes of this finest level.
    bool want_level(int max_level) const;
    /// Formats that watchers ask for and nobody has published.
    std::set<MeshFormat> unpublished_formats() const;
    /// One of them, of those whose finest level is there: in turn, each as often as the others.
    std::optional<MeshFormat> next_unpublished_format(const std::function<bool(int max_level)>& is_there);
    void publish(const MeshFormat& format, const std::shared_ptr<const EncodedFrame>& frame,
                 Keep keep = Keep::while_wanted);
    /// None if it was not published.
    std::shared_ptr<const EncodedFrame> published(const MeshFormat& format) const;

private:
    // With the lock held.
    /// The stride of the particles that the watch asks for; none if it asks for meshes, or no frame has come.
    std::optional<std::uint64_t> stride_of(const Watch& watch) const;
    bool want(const MeshFormat& format) const;
    bool keeps(const MeshFormat& format) const;
    bool want_stride(std::uint64_t stride) const;

    mutable std::mutex mutex_;                     ///< for what follows
    std::vector<std::shared_ptr<Watch>> watches_;  ///< those first whose format has waited longest for its turn
    std::uint64_t skipped_by_the_gone_ = 0;
    Encodings meshes_;
    std::set<MeshFormat> kept_;              ///< of those, until the next frame
    std::optional<MeshFormat> of_snapshot_;  ///< likewise, or until a snapshot in another format: many ask alike
    std::optional<std::uint64_t> particle_count_;
    std::map<std::uint64_t, std::shared_ptr<const ParticleMessages>> particles_;  ///< by stride
};

}  // namespace meniscus::server
