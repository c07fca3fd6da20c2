// Surfaces that the ranks make themselves (meniscus/mpi.h), for a session or as files.
#pragma once

#include <chrono>
#include <string>

#include "failure.hpp"
#include "frames.hpp"
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

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds first_pause{1}, longest_pause{30};

    // Results and errors are the same on all ranks, and said by rank 0.
    meniscus_result open();
    /// The error of the call before.
    Failure failure(meniscus_result result) const;
    /// Likewise.
    void lose(const std::string& consequence);
    void say_surfaces_go();

    text_options::Options parts_options_;
    /// None: the server is awaited. Ended by finish() alone, which all ranks call: not where a program ends without it.
    meniscus_parts* parts_ = nullptr;
    unsigned taken_since_ = 0;  ///< frames, since one was lost
    std::chrono::seconds pause_ = first_pause;
    Clock::time_point next_attempt_{};  ///< rank 0's counts
};

}  // namespace meniscus::catalyst
