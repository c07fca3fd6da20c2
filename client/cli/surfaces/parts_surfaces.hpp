// Surfaces reconstructed in this process in parts, one after the other.
#pragma once

#include <map>
#include <vector>

#include "cli/surfaces/local_coding.hpp"
#include "cli/surfaces/surfaces.hpp"
#include "meniscus/parts.hpp"

namespace meniscus::cli {

class PartsSurfaces : public Surfaces {
public:
    /// as_bricks: the parts' bricks are encoded, and no mesh is kept. Throws InvalidInput where their attributes are to
    /// be rounded, over a range that only the whole has.
    PartsSurfaces(const Settings& settings, const BackendOptions& backend, std::size_t parts, LocalCoding coding,
                  bool as_bricks, Handler handler);
    void submit(const ParticleFrame& frame, double simulation_time) override;
    void finish() override {}

private:
    void hand_over_mesh(client::FrameStatistics statistics, double simulation_time);
    void hand_over_bricks(client::FrameStatistics statistics);

    AloneExchange alone_;
    PartsReconstructor reconstructor_;
    LocalCoding coding_;
    bool as_bricks_;
    Handler handler_;
    std::uint64_t frames_ = 0;
    // Of this frame's parts, by number:
    std::map<std::size_t, Mesh> meshes_;
    std::map<std::size_t, client::ReceivedFrame> encoded_;
};

}  // namespace meniscus::cli
