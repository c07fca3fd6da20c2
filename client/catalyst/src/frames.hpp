// Where the frames of a simulation go.
#pragma once

#include <cstdint>
#include <string>

#include "meniscus/meniscus.h"

namespace meniscus::catalyst {

/// All ranks call its functions together. A frame goes from all ranks or from none.
class Frames {
public:
    virtual ~Frames() = default;
    /// particles: of this rank, borrowed; none if it has no frame, which is then left out on all. Throws Failure for
    /// what was wrong with a frame, and not for a server that is away.
    virtual void push(const meniscus_particles* particles, std::uint64_t index, double simulation_time) = 0;
    /// Waits for what is under way, and ends the session.
    virtual void finish() = 0;

    virtual const std::string& session_id() const noexcept = 0;
    virtual std::uint64_t sent() const noexcept = 0;
    /// Frames that were left out, since the server was away, a rank had none, or another one was being made.
    virtual std::uint64_t left_out() const noexcept = 0;
};

}  // namespace meniscus::catalyst
