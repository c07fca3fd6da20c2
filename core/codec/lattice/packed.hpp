// The packed profile: every section at fixed widths, so that each field's place follows by counting.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "codec/lattice/bit_stream.hpp"
#include "codec/lattice/brick_header.hpp"
#include "codec/lattice/lattice_brick.hpp"

namespace meniscus {

/// Appends the brick's bytes. bits: memory to work in.
void write_packed(const LatticeBrick& brick, BitWriter& bits, std::vector<std::byte>& out);

/// Reads what follows the header into a brick that is clear. Returns what is wrong with it, in words, or null.
const char* read_packed(const BrickHeader& header, std::span<const std::byte> bytes, const AnnouncedBrick& announced,
                        LatticeBrick& brick);

}  // namespace meniscus
