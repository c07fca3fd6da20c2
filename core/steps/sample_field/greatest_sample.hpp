// The greatest value of the field that was sampled: it explains a missing surface.
#pragma once

#include <cstdint>

#include "field/lattice_settings.hpp"
#include "steps/sample_field/sample_field.hpp"

namespace meniscus {

/// The greatest value at a block's sampled points inside the domain; 0 without any.
MENISCUS_HD inline float greatest_of_block(const BlocksView& blocks, std::uint32_t block, const LatticeSettings& s) {
    const BlockMask counted =
        s.has_domain ? domain_points(blocks.coordinate(block), s.domain_low, s.domain_high) : ~BlockMask{0};
    float greatest = 0.0F;
    for (BlockMask left = blocks.sampled[block] & counted; left != 0; left &= left - 1) {
        const float value = blocks.value(block, lowest_bit(left));
        if (value > greatest) greatest = value;
    }
    return greatest;
}

}  // namespace meniscus
