#include "cli/local_surfaces.hpp"

#include <utility>

namespace meniscus::cli {
namespace {

BackendOptions backend_options(unsigned threads) {
    BackendOptions options;
    options.threads = threads;
    return options;
}

}  // namespace

LocalSurfaces::LocalSurfaces(const Settings& settings, unsigned threads, Handler handler)
    : reconstructor_(settings, backend_options(threads)), handler_(std::move(handler)) {}

void LocalSurfaces::submit(const ParticleFrame& frame, double simulation_time) {
    reconstructor_.reconstruct(frame, mesh_);
    client::FrameStatistics statistics;
    static_cast<Statistics&>(statistics) = reconstructor_.statistics();
    handler_(Surface(mesh_, std::move(statistics), frames_++, simulation_time));
}

}  // namespace meniscus::cli
