// The bytes of a lattice brick become its mesh, or a refusal. Without exceptions: the viewer runs it, too.
#pragma once

#include <cstddef>
#include <span>

#include "codec/lattice/entropy.hpp"
#include "codec/lattice/lattice_brick.hpp"

namespace meniscus {

class LatticeDecoder {
public:
    /// Decodes either profile. origin: of the brick, in steps of c / 2^offset_bits. Returns what is wrong with the
    /// bytes, in words, or null. Its memory beside that of brick(): a fixed number of bytes, and no more than the
    /// brick's own cells can need.
    const char* decode(std::span<const std::byte> bytes, const AnnouncedBrick& announced,
                       const LatticePosition& origin);
    /// The one decoded last, with its mesh, of which parts may be moved away.
    LatticeBrick& brick() { return brick_; }

private:
    LatticeBrick brick_;
    EntropyReader entropy_;
};

}  // namespace meniscus
