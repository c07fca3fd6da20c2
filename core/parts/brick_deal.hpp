// Bricks dealt to parts, with what each process has in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "meniscus/brick_box.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus {

/// The work for a particle, in triangles. (core/README.md#parts-in-turn-in-one-process-or-several)
inline constexpr std::uint64_t particle_over_triangle = 7;
/// That for a particle of a brick beside a part, which the part gets, too.
inline constexpr std::uint64_t particle_beside_over_triangle = 3;
/// That for a brick, whatever is in it: drops fill few bricks, and reach many.
inline constexpr std::uint64_t brick_over_triangle = 1000;

/// What a process has in a brick.
struct BrickLoad {
    BrickCoordinate brick{};
    std::uint32_t rank = 0;
    std::uint32_t particles = 0;
    std::uint32_t triangles = 0;  ///< those that it has made there in the last frame

    /// But for that of the brick, which may have several loads. Whole: sums do not depend on their order.
    std::uint64_t work() const { return particle_over_triangle * particles + triangles; }
    std::uint64_t work_beside() const { return particle_beside_over_triangle * particles; }
    bool operator==(const BrickLoad&) const = default;
};
/// The bricks that hold particles of a valid frame of a process, by (z, y, x). each_stands_for: of each of such groups
/// of particles one is looked at, in a place that the group's number gives; at least 1.
std::vector<BrickLoad> brick_loads(const ParticleFrame& frame, const Settings& settings, std::uint32_t rank = 0,
                                   std::size_t each_stands_for = 1);

struct BrickDeal {
    std::vector<BrickBox> boxes;    ///< of the parts
    std::vector<BrickLoad> loads;   ///< those in the first box, then those in the next
    std::vector<std::size_t> ends;  ///< where in `loads` those of each part end

    std::span<const BrickLoad> loads_of(std::size_t part) const {
        const std::size_t begin = part == 0 ? 0 : ends[part - 1];
        return std::span(loads).subspan(begin, ends[part] - begin);
    }
};

/// Deals all bricks to parts: boxes that fill space, made by cutting boxes in two between bricks, such that the part
/// with most work has little: that of its bricks with what is in them, and for the particles of those around it. The
/// same for the same loads, in whatever order. parts: 1 to max_parts, else throws InvalidInput; there are fewer boxes
/// where a brick would have several.
BrickDeal deal_bricks(std::vector<BrickLoad> loads, std::size_t parts);

/// The rank that makes each part. Each maker has as many as the others, or one more. Parts are given away by the number
/// of particles that a maker has in one, the greatest first; what is left over goes to makers with fewer than they must
/// have. A rank without parts shares a machine with the maker before it, as a rule: its particles count as that
/// maker's, and those of ranks before all makers as the first one's. makers: ascending.
std::vector<std::size_t> deal_parts(const BrickDeal& deal, std::span<const std::size_t> makers);

}  // namespace meniscus
