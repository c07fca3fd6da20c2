// Particles for a session, whose server makes the surface: in parts if there are several ranks.
#pragma once

#include <optional>
#include <string>

#include "frames.hpp"
#include "session_opening.hpp"

namespace meniscus::catalyst {

/// A frame goes up from all ranks or from none, so that no part waits for one that does not come; after whatever ended
/// the session for one rank, all open it anew, as another run.
class SessionFrames final : public Frames {
public:
    /// Waits for one attempt to open the session. A server that is away is told, and awaited beside the simulation.
    /// Throws Failure on all ranks if the options are refused on one.
    SessionFrames(const RunOptions& options, const Ranks& ranks, Notices& notices);

    void push(const meniscus_particles* particles, std::uint64_t index, double simulation_time) override;
    void finish() override;

private:
    enum class State { lost, awaited, open };

    void open(bool again);
    /// Takes the session once it is open, and the answers that have come. Returns the agreed state, whether every rank
    /// has a frame beside it.
    State look();
    void take_answers();
    void lose(const std::string& why);
    /// Says why the server is awaited, if that was not said of this time.
    void say_awaited();

    std::uint64_t run_;
    std::optional<SessionOpening> opening_;
    Session session_;
};

}  // namespace meniscus::catalyst
