// The entropy profile: the same content as the packed one, each symbol at the length of its surprise.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "codec/lattice/bit_stream.hpp"
#include "codec/lattice/brick_header.hpp"
#include "codec/lattice/entropy_normals.hpp"
#include "codec/lattice/lattice_brick.hpp"
#include "codec/lattice/rans.hpp"

namespace meniscus {

/// What it works in is kept from brick to brick.
class EntropyWriter {
public:
    EntropyWriter();
    ~EntropyWriter();
    /// Appends the bytes of a brick, which has its mesh if it has normals.
    void write(LatticeBrick& brick, std::vector<std::byte>& out);

private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

class EntropyReader {
public:
    EntropyReader();
    ~EntropyReader();
    /// Reads what follows the header into a brick that is clear, but for its normals. Returns what is wrong, in words,
    /// or null. The bytes must stay until read_values().
    const char* read_geometry(const BrickHeader& header, std::span<const std::byte> bytes,
                              const AnnouncedBrick& announced, LatticeBrick& brick);
    /// The rest, once the brick has its mesh.
    const char* read_values(LatticeBrick& brick);

private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

}  // namespace meniscus
