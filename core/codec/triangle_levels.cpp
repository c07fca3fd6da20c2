// Crack triangles lie in planes of the base cells, the others inside one base cell.
#include "codec/triangle_levels.hpp"

#include <algorithm>
#include <string>

#include "meniscus/error.hpp"

namespace meniscus {

std::optional<std::uint16_t> cell_of_triangle(const LocalPosition& a, const LocalPosition& b, const LocalPosition& c,
                                              std::uint32_t offset_bits) {
    const auto edge = static_cast<unsigned>(base_cell_size) << offset_bits;
    unsigned cell = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (a[axis] == b[axis] && b[axis] == c[axis] && a[axis] % edge == 0) return std::nullopt;
        // The lowest vertex may lie on the cell's lower face, the highest on its upper one.
        const unsigned low = std::min({a[axis], b[axis], c[axis]}) / edge;
        cell |= std::min(low, brick_base_cells - 1U) << (4 * axis);
    }
    return static_cast<std::uint16_t>(cell);
}

std::vector<std::byte> pack_cell_levels(std::span<const std::uint8_t> level_of_cell) {
    std::vector<std::byte> packed;
    unsigned at = 0;
    for (const std::uint8_t level : level_of_cell) {
        if (level == 0) continue;
        if (at % 4 == 0) packed.push_back(std::byte{0});
        packed.back() |= static_cast<std::byte>(level << (2 * (at % 4)));
        ++at;
    }
    return packed;
}

std::vector<std::uint8_t> unpack_cell_levels(std::span<const std::byte> packed, std::span<const bool> occupied) {
    const auto cells = static_cast<std::size_t>(std::count(occupied.begin(), occupied.end(), true));
    if (packed.size() != (cells + 3) / 4)
        throw InvalidInput("the brick has " + std::to_string(packed.size()) + " bytes of cell levels, must have " +
                           std::to_string((cells + 3) / 4) + " for " + std::to_string(cells) + " cells");
    std::vector<std::uint8_t> levels(occupied.size(), 0);
    std::size_t at = 0;
    for (std::size_t i = 0; i < occupied.size(); ++i) {
        if (!occupied[i]) continue;
        levels[i] = std::to_integer<std::uint8_t>(packed[at / 4] >> (2 * (at % 4))) & 3;
        if (levels[i] == 0) throw InvalidInput("the brick gives a base cell the level 0, must be 1 to 3");
        ++at;
    }
    return levels;
}

}  // namespace meniscus
