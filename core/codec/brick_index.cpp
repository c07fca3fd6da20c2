// A hash table with linear probing, by multiplicative hashing.
#include "codec/brick_index.hpp"

#include <algorithm>
#include <bit>

namespace meniscus {

BrickIndex index_brick(const Mesh& mesh, const MeshBrick& brick, Array<std::uint32_t>& slots) {
    constexpr std::uint32_t empty = 0xFFFFFFFFU;
    constexpr std::uint32_t golden_ratio = 0x9E3779B9U;  // of 2^32: spreads neighboring numbers evenly
    const std::uint32_t triangle_count = brick.triangle_count();
    // Room for three vertices a triangle, so that a slot stays empty; connected triangles have half a vertex each.
    const auto bits = static_cast<std::uint32_t>(std::bit_width(3 * triangle_count | 1U));
    const std::size_t size = std::size_t{1} << bits;
    if (slots.size() < size) {
        slots = Array<std::uint32_t>(slots.get_allocator());  // gives the smaller table back first
        slots.resize(size);
    }
    std::fill_n(slots.begin(), size, empty);

    BrickIndex index;
    index.vertices.reserve(triangle_count);
    index.triangles.reserve(triangle_count);
    for (const TriangleRange& range : brick.ranges)
        for (std::uint32_t t = 0; t < range.count; ++t) {
            Triangle local;
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t v = mesh.triangles[range.first + t][i];
                std::size_t slot = (v * golden_ratio) >> (32U - bits);
                while (slots[slot] != empty && index.vertices[slots[slot]] != v) slot = (slot + 1) & (size - 1);
                if (slots[slot] == empty) {
                    slots[slot] = static_cast<std::uint32_t>(index.vertices.size());
                    index.vertices.push_back(v);
                }
                local[i] = slots[slot];
            }
            index.triangles.push_back(local);
        }
    return index;
}

}  // namespace meniscus
