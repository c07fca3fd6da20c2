// A simulation's run, from catalyst_initialize() to catalyst_finalize().
#pragma once

#include <cstdint>
#include <memory>

#include "frames.hpp"
#include "mesh_particles.hpp"
#include "node.hpp"
#include "notices.hpp"
#include "ranks.hpp"
#include "run_options.hpp"

namespace meniscus::catalyst {

class Run {
public:
    /// params: of catalyst_initialize(). environment: MENISCUS_CATALYST, may be null. Throws InvalidInput, NotBuilt and
    /// Failure; on all ranks if on one.
    Run(const Node& params, const char* environment);

    /// params: of catalyst_execute(). Throws as Run() does; what one rank lacks, all leave out.
    void execute(const Node& params);
    void finish() { frames_->finish(); }

    const Frames& frames() const noexcept { return *frames_; }

private:
    /// The data of the channel that has the particles; a node that is not there if this rank has none.
    Node mesh(const Node& params);
    const meniscus_particles& particles(const Node& params);
    void read_state(const Node& state);
    void require_order() const;

    Notices notices_;
    Ranks ranks_;
    RunOptions options_;
    MeshParticles particles_;
    std::unique_ptr<Frames> frames_;
    std::uint64_t index_ = 0;       ///< of the frame
    std::uint64_t next_index_ = 0;  ///< the least that the next one may have
    std::uint64_t executed_ = 0;    ///< frames so far, refused ones too
    double time_ = 0.0;
};

}  // namespace meniscus::catalyst
