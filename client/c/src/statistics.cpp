#include "statistics.hpp"

#include <algorithm>
#include <iterator>

namespace meniscus::c {

meniscus_statistics to_c(const Statistics& statistics) {
    meniscus_statistics out = MENISCUS_STATISTICS_INIT;
    out.particles = statistics.particles;
    out.vertices = statistics.vertices;
    out.triangles = statistics.triangles;
    static_assert(std::size(decltype(out.triangles_by_level){}) == triangle_level_count);
    std::copy(statistics.triangles_by_level.begin(), statistics.triangles_by_level.end(), out.triangles_by_level);
    out.spray_particles = statistics.spray_particles;
    out.volume = statistics.volume;
    out.particle_volume = statistics.particle_volume;
    out.field_evaluations = statistics.field_evaluations;
    out.total_seconds = statistics.total_seconds;
    static_assert(std::size(decltype(out.stage_seconds){}) == stage_count);
    std::copy(statistics.stage_seconds.begin(), statistics.stage_seconds.end(), out.stage_seconds);
    out.peak_bytes = statistics.peak_bytes;
    out.device_bytes = statistics.device_bytes;
    out.vertices_without_particles = statistics.vertices_without_particles;
    return out;
}

meniscus_statistics to_c(const client::FrameStatistics& statistics) {
    meniscus_statistics out = to_c(static_cast<const Statistics&>(statistics));
    out.encode_seconds = statistics.encode_seconds;
    out.latency_seconds = statistics.latency_seconds;
    out.encoded_bytes = statistics.encoded_bytes;
    return out;
}

}  // namespace meniscus::c
