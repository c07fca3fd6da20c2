// What a process has in bricks, by which they are dealt.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "meniscus/brick_box.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus {

/// The work for a particle, in triangles. (core/README.md#parts-in-turn-in-one-process-or-several)
inline constexpr std::uint64_t particle_over_triangle = 7;
/// That for a particle of a brick beside a part, which the part gets, too.
inline constexpr std::uint64_t particle_beside_over_triangle = 3;
/// That for a brick with surface, beside its triangles: spray is little water in many bricks.
inline constexpr std::uint32_t brick_over_triangle = 1000;

/// What a process has in a brick.
struct BrickLoad {
    BrickCoordinate brick{};
    std::uint32_t rank = 0;
    std::uint32_t particles = 0;
    std::uint32_t surface = 0;  ///< the work for what it has made there in the last frame, in triangles

    /// Whole: its sums do not depend on their order.
    std::uint64_t work() const { return particle_over_triangle * particles + surface; }
    std::uint64_t work_beside() const { return particle_beside_over_triangle * particles; }
    bool operator==(const BrickLoad&) const = default;
};

/// The bricks that hold particles of a valid frame of a process, by (z, y, x). each_stands_for: of each of such groups
/// of particles one is looked at, in a place that the group's number gives; at least 1.
std::vector<BrickLoad> brick_loads(const ParticleFrame& frame, const Settings& settings, std::uint32_t rank = 0,
                                   std::size_t each_stands_for = 1);

/// The bricks that hold surface of a process. Where there are more than `most`, at least 1, they are cut into runs, and
/// one brick of each run has all of the run's: a message to all processes has a bound.
std::vector<BrickLoad> surface_loads(const Mesh& mesh, std::uint32_t rank, std::size_t most);

}  // namespace meniscus
