// The blocks that a brick's triangles depend on: its own 16 x 16 x 16, and those on its upper faces, which belong to
// the bricks beyond.
#pragma once

#include "lattice/brick_grid.hpp"
#include "lattice/coordinates.hpp"

namespace meniscus {

inline constexpr int closed_side = brick_size + 1;
inline constexpr int closed_places = closed_side * closed_side * closed_side;

/// The distance of two places one block apart along an axis.
constexpr int closed_step(int axis) {
    return axis == 0 ? 1 : axis == 1 ? closed_side : closed_side * closed_side;
}
/// The distance to the block at steps of 0 or 1 along each axis, i = dx + 2 dy + 4 dz.
constexpr int closed_steps(int i) {
    return (i & 1) * closed_step(0) + (i >> 1 & 1) * closed_step(1) + (i >> 2) * closed_step(2);
}
constexpr int closed_place(int x, int y, int z) {
    return x * closed_step(0) + y * closed_step(1) + z * closed_step(2);
}
constexpr Int3 closed_coordinate(int place) {
    return {place % closed_side, place / closed_side % closed_side, place / closed_step(2)};
}

/// An array with an element for every place. Steps along the axes from any place stay inside: those that leave the
/// closed brick come to its border or to a place on an upper face, where no cell of the brick is.
template <class T>
class ClosedArray {
public:
    T& operator[](int place) { return elements_[place + border]; }
    const T& operator[](int place) const { return elements_[place + border]; }
    T* data() { return elements_ + border; }
    void fill(const T& value) {
        for (T& element : elements_) element = value;
    }

private:
    static constexpr int border = closed_steps(7);
    T elements_[closed_places + 2 * border] = {};
};

}  // namespace meniscus
