// The seams of a part, from the hashes of its bricks' borders.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lattice/brick_grid.hpp"
#include "lattice/lattice_part.hpp"
#include "lattice/word_hash.hpp"
#include "meniscus/part.hpp"

namespace meniscus {

/// The order of a part's seams: by first, then by second.
bool comes_before(const Seam& a, const Seam& b);
/// keys: brick_key of each stored brick, ascending. hashes: of each, towards each of its neighbor slots.
std::vector<Seam> seams_of(const LatticePart& part, std::span<const std::uint64_t> keys,
                           std::span<const WordHash> hashes);

/// Throws InvalidInput for a box or an overlap out of range.
void validate(const FramePart& part);
/// The part in the lattice's terms; it is valid.
LatticePart lattice_part(const FramePart& part);

}  // namespace meniscus
