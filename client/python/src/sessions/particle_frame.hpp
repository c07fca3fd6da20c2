// Frames of particles as Python sees them.
#pragma once

#include <memory>
#include <utility>

#include "meniscus/client/particle_watcher.hpp"

namespace meniscus::python {

/// The class _meniscus.ParticleFrame.
struct ParticleFrameHandle {
    std::shared_ptr<const client::ReceivedParticles> frame;
};

inline ParticleFrameHandle handle_of(client::ReceivedParticles&& frame) {
    return {std::make_shared<const client::ReceivedParticles>(std::move(frame))};
}

}  // namespace meniscus::python
