// A frame's bricks that stay on the GPU on which they were packed, for a program that sends them on from there.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/packed_bricks.hpp"

namespace meniscus {

struct DevicePackedBrick {
    std::array<std::int32_t, 3> coordinate{};  ///< x y z in bricks
    std::uint32_t vertices = 0;
    std::uint32_t triangles = 0;
    ContentHash hash{};  ///< PackedBricks::hash()
    DeviceBytes bytes;   ///< complete on every stream
};

/// The bytes of the bricks are those that the CPU packs.
struct DevicePackedFrame {
    std::vector<DevicePackedBrick> bricks;   ///< those with triangles, ordered by coordinate (z, y, x)
    std::vector<CodedAttribute> attributes;  ///< of the vertices in the bricks
    double cell_size = 0.0;                  ///< finest cell's edge c, world units
    std::uint32_t offset_bits = 0;           ///< vertices lie on multiples of c / 2^offset_bits
    /// Holds the bytes, also after the reconstructor's next call and its end; and brings bricks down, by their index.
    std::shared_ptr<PackedBricks> memory;
};

}  // namespace meniscus
