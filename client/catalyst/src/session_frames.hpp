// Where frames go: to a session of a meniscusd, in parts if there are several ranks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "failure.hpp"
#include "meniscus/meniscus.h"
#include "notices.hpp"
#include "ranks.hpp"
#include "run_options.hpp"
#include "session_opening.hpp"

namespace meniscus::catalyst {

/// All ranks call its functions together. A frame goes up from all ranks or from none, so that no part waits for one
/// that does not come; after whatever ended the session for one rank, all open it anew, as another run.
class SessionFrames {
public:
    /// Waits for one attempt to open the session. A server that is away is told, and awaited beside the simulation.
    /// Throws Failure on all ranks if the options are refused on one.
    SessionFrames(const RunOptions& options, const Ranks& ranks, Notices& notices);

    /// particles: of this rank, borrowed; none if it has no frame, which is then left out on all. Throws Failure for
    /// what was wrong with a frame, and not for a server that is away.
    void push(const meniscus_particles* particles, std::uint64_t index, double simulation_time);
    /// Waits for the answers to what is under way, and ends the session.
    void finish();

    const std::string& session_id() const noexcept { return id_; }
    std::uint64_t sent() const noexcept { return sent_; }
    /// Frames that were left out while the server was away, or since a rank had none.
    std::uint64_t left_out() const noexcept { return left_out_; }

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

    const RunOptions& options_;
    const Ranks& ranks_;
    Notices& notices_;
    std::string id_;
    std::uint64_t run_ = 0;
    std::optional<SessionOpening> opening_;
    Session session_;
    std::string awaited_since_;  ///< what was said of it
    std::uint64_t left_out_meanwhile_ = 0;
    std::uint64_t sent_ = 0;
    std::uint64_t left_out_ = 0;
};

}  // namespace meniscus::catalyst
