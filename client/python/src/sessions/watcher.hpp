// Watchers of meshes and of particles as Python sees them.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "meniscus/client/particle_watcher.hpp"
#include "meniscus/client/watcher.hpp"
#include "sessions/frame_source.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::python {

// Both throw InvalidInput for an option that is wrong.

client::WatchOptions watch_options(const text_options::Options& options, const pybind11::object& on_reconnect);
client::ParticleWatchOptions particle_watch_options(const text_options::Options& options,
                                                    const pybind11::object& on_reconnect);

/// The class _meniscus.Watcher.
class WatchSource : public FrameSource<client::Watcher> {
public:
    using FrameSource::FrameSource;

    /// Why the session ended; empty before.
    std::string end_reason() const;
};
/// The class _meniscus.ParticleWatcher.
using ParticleSource = FrameSource<client::ParticleWatcher>;

}  // namespace meniscus::python
