#include "cli/surfaces/local_surfaces.hpp"

#include <malloc.h>

#include <utility>

#include "meniscus/mesh_normals.hpp"

namespace meniscus::cli {

LocalSurfaces::LocalSurfaces(const Settings& settings, const BackendOptions& options, client::NormalsBy normals_by,
                             std::optional<int> normal_bits, int attribute_bits, Codec codec, bool only_one,
                             Handler handler)
    : reconstructor_(settings, options),
      normals_by_(normals_by),
      normal_bits_(normal_bits),
      attributes_{{.name = {}, .bits = attribute_bits}},
      codec_(codec),
      only_one_(only_one),
      handler_(std::move(handler)) {
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
    CodingOptions coding{.codec = codec_};
    if (normals_by_ == client::NormalsBy::receiver) compute_normals(mesh_);
    if (normal_bits_) {
        round_normals(mesh_, *normal_bits_);
        coding.normal_bits = *normal_bits_;
    }
    // Before they are rounded, as a server does: the range of what is rounded may be another.
    coding.attributes = coded_attributes(mesh_, attribute_ranges(mesh_), attributes_);
    round_attributes(mesh_, attributes_);
    Surface surface(mesh_, std::move(statistics), frames_++, simulation_time, coding);
    handler_(surface);
}

}  // namespace meniscus::cli
