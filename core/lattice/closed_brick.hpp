// The blocks that a brick's triangles depend on: its own 16 x 16 x 16, and those on its upper faces, which belong to
// the bricks beyond.
#pragma once

#include <cstdint>

#include "lattice/bits.hpp"
#include "lattice/brick_grid.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

inline constexpr int closed_side = brick_size + 1;
inline constexpr int closed_places = closed_side * closed_side * closed_side;

/// The distance of two places one block apart along an axis.
MENISCUS_HD constexpr int closed_step(int axis) {
    return axis == 0 ? 1 : axis == 1 ? closed_side : closed_side * closed_side;
}
/// The distance to the block at steps of 0 or 1 along each axis, i = dx + 2 dy + 4 dz.
MENISCUS_HD constexpr int closed_steps(int i) {
    return (i & 1) * closed_step(0) + (i >> 1 & 1) * closed_step(1) + (i >> 2) * closed_step(2);
}
MENISCUS_HD constexpr int closed_place(int x, int y, int z) {
    return x * closed_step(0) + y * closed_step(1) + z * closed_step(2);
}
MENISCUS_HD constexpr Int3 closed_coordinate(int place) {
    return {place % closed_side, place / closed_side % closed_side, place / closed_step(2)};
}

/// A set of places.
class ClosedPlaces {
public:
    static constexpr int words = closed_places / 64 + 2;  // pairs may reach one word further

    /// The blocks that a cell's points lie in.
    void add_cell(int place) {
        for (int i = 0; i < 8; i += 2) {
            const int first = place + closed_steps(i);
            words_[first >> 6] |= std::uint64_t{3} << (first & 63);
            if ((first & 63) == 63) words_[(first >> 6) + 1] |= 1;
        }
    }
    std::uint32_t count() const {
        int total = 0;
        for (const std::uint64_t word : words_) total += popcount(word);
        return static_cast<std::uint32_t>(total);
    }
    /// Calls visit(place), in ascending order.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (int w = 0; w < words; ++w)
            for (std::uint64_t left = words_[w]; left != 0; left &= left - 1) visit(64 * w + lowest_bit(left));
    }

private:
    std::uint64_t words_[words] = {};
};

/// An array with an element for every place. Steps along the axes from any place stay inside: those that leave the
/// closed brick come to its border or to a place on an upper face, where no cell of the brick is.
template <class T>
class ClosedArray {
public:
    static constexpr int border = closed_steps(7);

    T& operator[](int place) { return elements_[place + border]; }
    const T& operator[](int place) const { return elements_[place + border]; }
    T* data() { return elements_ + border; }

private:
    T elements_[closed_places + 2 * border] = {};
};

}  // namespace meniscus
