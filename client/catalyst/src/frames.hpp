// Where the frames of a simulation go: to a session of a meniscusd, or to files.
#pragma once

#include <cstdint>
#include <string>

#include "meniscus/meniscus.h"
#include "notices.hpp"
#include "ranks.hpp"
#include "run_name.hpp"
#include "run_options.hpp"

namespace meniscus::catalyst {

/// All ranks call its functions together. A frame goes from all ranks or from none.
class Frames {
public:
    virtual ~Frames() = default;
    Frames(const Frames&) = delete;
    Frames& operator=(const Frames&) = delete;

    /// particles: of this rank, borrowed; none if it has no frame, which is then left out on all. Throws Failure for
    /// what was wrong with a frame, and not for a server that is away.
    virtual void push(const meniscus_particles* particles, std::uint64_t index, double simulation_time) = 0;
    /// Waits for what is under way, and ends the session.
    virtual void finish() = 0;

    const std::string& session_id() const noexcept { return name_.session_id; }
    /// A folder of files, in place of the session; empty: none.
    const std::string& output() const noexcept { return options_.output; }
    std::uint64_t sent() const noexcept { return sent_; }
    /// Frames that were left out: the server was away, a rank had none, or another one was being made.
    std::uint64_t left_out() const noexcept { return left_out_; }

protected:
    Frames(const RunOptions& options, const Ranks& ranks, Notices& notices);

    /// The number of the first run.
    std::uint64_t first_run() const noexcept { return name_.run; }
    void count_sent() { ++sent_; }
    /// is_away: for want of the session.
    void count_left_out(bool is_away);
    /// By rank 0: the session is open, and so many frames were left out for want of it. what: goes there.
    void say_open(const std::string& what);
    /// Why the session is not open, and what becomes of frames; a reason that is the last one's is not said again.
    void say_away(const std::string& why, const std::string& consequence);
    /// Whether that was said since the session was open.
    bool is_said_away() const noexcept { return !said_.empty(); }
    /// By rank 0, if frames were left out.
    void say_counts() const;

    const RunOptions& options_;
    const Ranks& ranks_;
    Notices& notices_;

private:
    const RunName name_;
    std::string said_;  ///< the reason why the session is not open
    std::uint64_t sent_ = 0;
    std::uint64_t left_out_ = 0;
    std::uint64_t left_out_meanwhile_ = 0;  ///< of these, for want of the session, since it was open
};

}  // namespace meniscus::catalyst
