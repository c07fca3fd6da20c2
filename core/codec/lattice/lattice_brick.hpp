// All that a brick's bytes hold, in whatever profile: its lattice, and the values of its vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/lattice/brick_lattice.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus {

/// The vertices are in the order of BrickLattice's numbers.
struct LatticeBrick {
    BrickLattice lattice;
    int offset_bits = 0;                 ///< 2 to 8
    int normal_bits = 0;                 ///< 2 to 16; 0: no normals
    std::vector<std::uint8_t> offsets;   ///< place on the vertex's edge, in steps of c / 2^offset_bits, not 0
    std::vector<std::uint32_t> normals;  ///< Octahedron::code()
    std::vector<std::vector<std::byte>> attributes;  ///< CodedAttribute::coded_bytes() for each vertex

    // What follows of those, see make_mesh().
    std::vector<LatticePosition> positions;
    std::vector<Triangle> triangles;
    std::vector<TriangleLevel> levels;

    void clear() {
        lattice.clear();
        offsets.clear();
        normals.clear();
        attributes.clear();
        positions.clear();
        triangles.clear();
        levels.clear();
    }
};

/// What a receiver knows of a brick before it reads its bytes.
struct AnnouncedBrick {
    std::uint32_t vertices = 0;
    std::uint32_t triangles = 0;
    int offset_bits = 0;
    std::span<const std::size_t> attribute_bytes;  ///< of each attribute, for one vertex
};

/// Reads attributes as they are: the values of one after those of the other. Returns what is wrong, in words, or null.
inline const char* read_attributes(std::span<const std::byte> bytes, const AnnouncedBrick& announced,
                                   LatticeBrick& brick) {
    for (const std::size_t size : announced.attribute_bytes) {
        if (announced.vertices > bytes.size() / size) return "ends within its attributes";
        const std::span<const std::byte> values = bytes.first(announced.vertices * size);
        brick.attributes.emplace_back(values.begin(), values.end());
        bytes = bytes.subspan(values.size());
    }
    return bytes.empty() ? nullptr : "goes on behind its end";
}

}  // namespace meniscus
