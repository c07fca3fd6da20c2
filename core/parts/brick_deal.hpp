// Bricks dealt to parts, with what each process has in them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "meniscus/brick_box.hpp"
#include "parts/brick_loads.hpp"

namespace meniscus {

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
/// with most work has little: that of its bricks, and for the particles of those around it. The same for the same
/// loads, in whatever order. parts: 1 to max_parts, else throws InvalidInput; there are fewer boxes where a brick would
/// have several.
BrickDeal deal_bricks(std::vector<BrickLoad> loads, std::size_t parts);

/// The rank that makes each part. Each maker has as many as the others, or one more. Parts are given away by the number
/// of particles that a maker has in one, the greatest first; what is left over goes to makers with fewer than they must
/// have. A rank without parts shares a machine with the maker before it, as a rule: its particles count as that
/// maker's, and those of ranks before all makers as the first one's. makers: ascending.
std::vector<std::size_t> deal_parts(const BrickDeal& deal, std::span<const std::size_t> makers);

}  // namespace meniscus
