// Surfaces that the ranks make themselves (meniscus/mpi.h), for a session of a meniscusd.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "failure.hpp"
#include "frames.hpp"
#include "notices.hpp"
#include "ranks.hpp"
#include "run_options.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::catalyst {

class PartsFrames final : public Frames {
public:
    /// Asks for the server once, for the option "timeout" at most. One that is away is told, and asked for again by
    /// push(), after 1, 2, 4 and at last every 30 seconds. Throws Failure on all ranks if the options are refused on
    /// one.
    PartsFrames(const RunOptions& options, const Ranks& ranks, Notices& notices);

    void push(const meniscus_particles* particles, std::uint64_t index, double simulation_time) override;
    void finish() override;
    const std::string& session_id() const noexcept override { return id_; }
    std::uint64_t sent() const noexcept override { return sent_; }
    std::uint64_t left_out() const noexcept override { return left_out_; }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds first_pause{1}, longest_pause{30};

    /// Returns what is the same on all ranks.
    meniscus_result open();
    /// The error of the call before.
    Failure failure(meniscus_result result) const;
    void say_there();
    /// Why frames are left out, once of each reason. until: what they then wait for, with its " until".
    void say_left_out(const std::string& until);
    void leave_out(bool is_away);

    const Ranks& ranks_;
    Notices& notices_;
    text_options::Options options_;
    std::string id_;
    std::string server_;
    /// None: the server is awaited. Ended by finish() alone, which all ranks call: not where a program ends without it.
    meniscus_parts* parts_ = nullptr;
    std::string said_;          ///< of a server that is away; empty: it is there
    unsigned taken_since_ = 0;  ///< frames, since then
    std::chrono::seconds pause_ = first_pause;
    Clock::time_point next_attempt_{};  ///< rank 0's counts
    std::uint64_t sent_ = 0;
    std::uint64_t left_out_ = 0;
    std::uint64_t left_out_meanwhile_ = 0;  ///< since the server was there
};

}  // namespace meniscus::catalyst
