#include "cli/surfaces/local_surfaces.hpp"

#include <malloc.h>

#include <utility>

namespace meniscus::cli {

LocalSurfaces::LocalSurfaces(const Settings& settings, const BackendOptions& options, const LocalCoding& coding,
                             bool only_one, Handler handler)
    : reconstructor_(settings, options), coding_(coding), only_one_(only_one), handler_(std::move(handler)) {
    // Memory that is given back goes to the system: main() would keep it for further frames.
    constexpr int smallest_array = 1 << 20;
    if (only_one) mallopt(M_MMAP_THRESHOLD, smallest_array);
}

void LocalSurfaces::submit(const ParticleFrame& frame, double simulation_time) {
    if (only_one_)
        reconstructor_.reconstruct_last(frame, mesh_);
    else
        reconstructor_.reconstruct(frame, mesh_);
    client::FrameStatistics statistics;
    static_cast<Statistics&>(statistics) = reconstructor_.statistics();
    const CodingOptions coding = coding_.round(mesh_);
    Surface surface(mesh_, std::move(statistics), frames_++, simulation_time, coding);
    handler_(surface);
}

}  // namespace meniscus::cli
