// Where frames go: to a session of a meniscusd, in parts if there are several ranks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "frames.hpp"
#include "notices.hpp"
#include "ranks.hpp"
#include "run_options.hpp"
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
    const std::string& session_id() const noexcept override { return id_; }
    std::uint64_t sent() const noexcept override { return sent_; }
    std::uint64_t left_out() const noexcept override { return left_out_; }

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
