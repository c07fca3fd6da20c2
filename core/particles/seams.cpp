// Parts of frames: their checks, their lattice, their reach and their seams.
#include "particles/seams.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "meniscus/error.hpp"

namespace meniscus {
namespace {

BrickCoordinate as_array(const Int3& c) {
    return {c.x, c.y, c.z};
}

/// bricks times the cells of one, within what the lattice can address and the overlap can add.
Int3 base_cells(const BrickCoordinate& bricks) {
    return {bricks[0] * brick_size, bricks[1] * brick_size, bricks[2] * brick_size};
}

}  // namespace

bool comes_before(const Seam& a, const Seam& b) {
    const auto key = [](const BrickCoordinate& c) { return brick_key({c[0], c[1], c[2]}); };
    return key(a.first) != key(b.first) ? key(a.first) < key(b.first) : key(a.second) < key(b.second);
}

std::vector<Seam> seams_of(const LatticePart& part, std::span<const std::uint64_t> keys,
                           std::span<const WordHash> hashes) {
    std::vector<Seam> sides;
    for (std::size_t b = 0; b < keys.size(); ++b) {
        const Int3 brick = brick_coordinate(keys[b]);
        for (int slot = 0; slot < neighbor_slots; ++slot) {
            const WordHash& hash = hashes[b * neighbor_slots + static_cast<std::size_t>(slot)];
            const Int3 other = brick + neighbor_offset(slot);
            if ((hash.of[0] | hash.of[1]) == 0 || part.owns_brick(brick) == part.owns_brick(other)) continue;
            Seam& side = sides.emplace_back();
            side.first = as_array(slot > own_slot ? brick : other);
            side.second = as_array(slot > own_slot ? other : brick);
            side.hash = {hash.of[0], hash.of[1]};
        }
    }
    std::sort(sides.begin(), sides.end(), comes_before);
    std::vector<Seam> seams;
    for (const Seam& side : sides) {
        if (!seams.empty() && seams.back().first == side.first && seams.back().second == side.second)
            for (std::size_t i = 0; i < side.hash.size(); ++i) seams.back().hash[i] += side.hash[i];
        else
            seams.push_back(side);
    }
    return seams;
}

void validate(const FramePart& part) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int32_t low = part.own.low[axis], high = part.own.high[axis];
        if (low >= high || low < -brick_end || high > brick_end)
            throw InvalidInput("a part has the bricks from " + std::to_string(low) + " to below " +
                               std::to_string(high) + " along " + std::string(axes[axis]) +
                               "; it must have one at least, of those from " + std::to_string(-brick_end) +
                               " to below " + std::to_string(brick_end));
    }
    if (part.overlap < 1 || part.overlap > max_overlap)
        throw InvalidInput("a part's overlap is " + std::to_string(part.overlap) + " base cells, must be 1 to " +
                           std::to_string(max_overlap));
}

Box reach_of(const FramePart& part, const Settings& settings, unsigned coarsest_level) {
    const double c = world_cell_size(settings);
    const double beyond = std::ldexp(margin(settings) * settings.particle_radius, static_cast<int>(coarsest_level)) +
                          static_cast<double>(part.overlap) * base_cell_size * c;
    Box box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.min[axis] = static_cast<double>(part.own.low[axis]) * brick_cells * c - beyond;
        box.max[axis] = static_cast<double>(part.own.high[axis]) * brick_cells * c + beyond;
    }
    return box;
}

LatticePart lattice_part(const FramePart& part) {
    LatticePart result;
    result.is_whole = false;
    result.own = {base_cells(part.own.low), base_cells(part.own.high)};
    result.settling = result.own.widened(static_cast<std::int32_t>(part.overlap));
    return result;
}

}  // namespace meniscus
