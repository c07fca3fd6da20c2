#include "parts/brick_loads.hpp"

#include <algorithm>
#include <bit>
#include <span>

#include "lattice/brick_grid.hpp"
#include "particles/positions.hpp"
#include "parts/brick_counts.hpp"

namespace meniscus {

std::vector<BrickLoad> brick_loads(const ParticleFrame& frame, const Settings& settings, std::uint32_t rank,
                                   std::size_t each_stands_for) {
    const PositionsView positions = positions_view(frame, units_per_length(settings));
    constexpr auto edge = static_cast<std::uint64_t>(units_per_base_cell * brick_size);
    static_assert(std::has_single_bit(edge));
    const auto brick = [&](std::int64_t unit) { return static_cast<std::int32_t>(unit >> std::countr_zero(edge)); };
    BrickCounts counts;
    // The same place in each group would be one layer of particles that lie in rows: places follow the golden ratio.
    std::uint32_t fraction = 0;  // of 2^32
    for (std::size_t first = 0; first < frame.count(); first += each_stands_for) {
        const std::size_t group = std::min(each_stands_for, frame.count() - first);
        const Units3 p = positions.snapped(first + static_cast<std::size_t>(group * std::uint64_t{fraction} >> 32));
        fraction += 0x9E3779B9U;
        counts.add(brick_key({brick(p.x), brick(p.y), brick(p.z)}), group);
    }
    std::vector<BrickCounts::Count> all = counts.take();
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    std::vector<BrickLoad> loads;
    loads.reserve(all.size());
    for (const BrickCounts::Count& count : all) {
        const Int3 at = brick_coordinate(count.key);
        loads.push_back({{at.x, at.y, at.z}, rank, static_cast<std::uint32_t>(count.particles), 0});
    }
    return loads;
}

std::vector<BrickLoad> surface_loads(const Mesh& mesh, std::uint32_t rank, std::size_t most) {
    const std::span<const MeshBrick> bricks(mesh.bricks);
    const std::size_t group = (bricks.size() + most - 1) / most;
    std::vector<BrickLoad> loads;
    for (std::size_t first = 0; first < bricks.size(); first += group) {
        const std::size_t end = std::min(first + group, bricks.size());
        BrickLoad load{bricks[(first + end) / 2].coordinate, rank, 0, 0};
        for (std::size_t b = first; b < end; ++b) load.surface += brick_over_triangle + bricks[b].triangle_count();
        loads.push_back(load);
    }
    return loads;
}

}  // namespace meniscus
