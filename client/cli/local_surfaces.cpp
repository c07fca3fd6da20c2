#include "cli/local_surfaces.hpp"

#include <utility>

namespace meniscus::cli {

LocalSurfaces::LocalSurfaces(const Settings& settings, const BackendOptions& options, Handler handler)
    : reconstructor_(settings, options), handler_(std::move(handler)) {}

void LocalSurfaces::submit(const ParticleFrame& frame, double simulation_time) {
    reconstructor_.reconstruct(frame, mesh_);
    client::FrameStatistics statistics;
    static_cast<Statistics&>(statistics) = reconstructor_.statistics();
    handler_(Surface(mesh_, std::move(statistics), frames_++, simulation_time));
}

}  // namespace meniscus::cli
