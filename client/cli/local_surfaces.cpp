#include "cli/local_surfaces.hpp"

#include <utility>

namespace meniscus::cli {

LocalSurfaces::LocalSurfaces(const Settings& settings, const BackendOptions& options, std::optional<int> normal_bits,
                             int attribute_bits, Handler handler)
    : reconstructor_(settings, options),
      normal_bits_(normal_bits),
      attributes_{{.name = {}, .bits = attribute_bits}},
      handler_(std::move(handler)) {}

void LocalSurfaces::submit(const ParticleFrame& frame, double simulation_time) {
    reconstructor_.reconstruct(frame, mesh_);
    client::FrameStatistics statistics;
    static_cast<Statistics&>(statistics) = reconstructor_.statistics();
    CodingOptions coding;
    if (normal_bits_) {
        round_normals(mesh_, *normal_bits_);
        coding.normal_bits = *normal_bits_;
    }
    // Before they are rounded, as a server does: the range of what is rounded may be another.
    coding.attributes = coded_attributes(mesh_, attribute_ranges(mesh_), attributes_);
    round_attributes(mesh_, attributes_);
    handler_(Surface(mesh_, std::move(statistics), frames_++, simulation_time, coding));
}

}  // namespace meniscus::cli
