// The particles of a session's frames, on their way to the observers and to watchers of particles.
#pragma once

#include <memory>
#include <string>

#include "sessions/intake/input_slots.hpp"
#include "sessions/intake/upload.hpp"
#include "sessions/session/session_observer.hpp"
#include "sessions/watching/watchers.hpp"

namespace meniscus::server {

/// The particles that the reconstructing thread shows. They are encoded once for each stride that watchers ask for.
class ShownParticles {
public:
    /// session: its id, for the log. particle_radius: of level 0, world units.
    ShownParticles(std::string session, double particle_radius, InputSlots& inputs, Watchers& watchers,
                   SessionObservers observers);

    /// Shows the observers a frame that was reconstructed. Does nothing, and returns false, if the run has shown the
    /// frame already, before it was resumed.
    bool show(InputFrame& input, Run& run);
    /// Encodes the frame that was shown last, for watchers.
    void encode(const InputFrame& input);
    /// Shows the newest frame to a watcher that has come since, unless another frame is on its way into its slot.
    void show_again();

    /// Keeps the newest frame outside of the slots, where no other frame replaces it. Returns false if there is none,
    /// or one has.
    bool keep();
    /// The frame that was kept; null once a newer one was shown.
    const InputFrame* kept() const noexcept { return newest_ == &kept_ ? &kept_ : nullptr; }
    /// Frees what was kept.
    void forget() {
        newest_ = nullptr;
        kept_.free_memory();
    }

private:
    const std::string session_;
    const double particle_radius_;
    InputSlots& inputs_;
    Watchers& watchers_;
    const SessionObservers observers_;
    InputFrame* newest_ = nullptr;  ///< the frame that was shown last
    InputFrame kept_{nullptr};
};

}  // namespace meniscus::server
