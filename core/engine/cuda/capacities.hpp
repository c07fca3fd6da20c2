// How much room the arrays of a frame have, and how that grows.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/growth.hpp"
#include "lattice/brick_grid.hpp"
#include "lattice/host_device.hpp"

namespace meniscus::cuda {

/// The kinds of elements that a frame may need more of than there is room for. Their numbers become known on the device
/// alone, in this order.
enum class Resource : std::uint8_t {
    boxed_bricks,    ///< bricks of support cells in the boxes around each level's particles; keys are their numbers
    reached_box,     ///< bricks of base cells in the box around all that particles may reach; keys are their numbers
    cell_particles,  ///< particles in the fullest support cell, where they are too many; see orders_whole_keys()
    particle_bricks,
    reached_bricks,
    bricks,
    blocks,
    samples,
    vertices,
    triangles,
    lattice_blocks  ///< blocks of the closed bricks, where the lattice is kept
};
inline constexpr std::size_t resource_count = 11;

/// Elements are numbered with 32 bits, and so are the words of all bricks: a frame that needs as many or more is
/// refused. Boxes are no arrays, and may be as large as the world.
MENISCUS_HD constexpr std::uint64_t too_many(Resource r) {
    if (r == Resource::boxed_bricks || r == Resource::reached_box) return std::uint64_t{1} << 62;
    return r == Resource::bricks ? no_index / Brick::words : no_index;
}

struct Capacities {
    std::uint64_t particles = 0;
    std::array<std::uint64_t, resource_count> of{};

    MENISCUS_HD std::uint64_t operator[](Resource r) const { return of[static_cast<std::size_t>(r)]; }

    /// Particles are sorted by support cell, and those of a cell find their places by counting. Where a cell holds more
    /// than this many, or cells of the boxes are too many for a number of 64 bits, whole keys are sorted.
    static constexpr std::uint64_t most_counted_in_cell = 256;
    MENISCUS_HD bool orders_whole_keys() const {
        return (*this)[Resource::cell_particles] > most_counted_in_cell ||
               (*this)[Resource::boxed_bricks] > std::uint64_t{1} << (64 - brick_index_bits - 1);
    }

    /// Grows to the need and an eighth more; returns whether there was too little.
    bool grow_to(std::uint64_t needed_particles, const unsigned long long (&needed)[resource_count]) {
        bool grown = grow(particles, needed_particles, no_index);
        for (std::size_t i = 0; i < resource_count; ++i) {
            const auto r = static_cast<Resource>(i);
            grown |=
                grow(of[i], std::max<std::uint64_t>(needed[i], expected(r, needed_particles, needed)), too_many(r));
        }
        return grown;
    }

    /// Whether all arrays but the mesh's have the same room. The first three resources have no arrays.
    bool same_but_for_mesh(const Capacities& other) const {
        constexpr auto first = static_cast<std::ptrdiff_t>(Resource::particle_bricks);
        constexpr auto end = static_cast<std::ptrdiff_t>(Resource::vertices);
        return particles == other.particles &&
               std::equal(of.begin() + first, of.begin() + end, other.of.begin() + first);
    }

private:
    /// A guess at the need of elements that a stopped frame has not counted yet: every discovery costs a run.
    static std::uint64_t expected(Resource r, std::uint64_t particles,
                                  const unsigned long long (&needed)[resource_count]) {
        if (r == Resource::reached_bricks) return particles / 8;  // most frames need fewer; 20 bytes each
        if (r == Resource::samples) return needed[static_cast<std::size_t>(Resource::blocks)];  // each has one at least
        // A uniform surface has some 13 triangles a block; an adaptive one, fewer.
        if (r == Resource::lattice_blocks) return needed[static_cast<std::size_t>(Resource::triangles)] / 12;
        return 0;
    }
    /// Grows one capacity to the need and an eighth more, the latter only up to `most`; returns whether there was too
    /// little.
    static bool grow(std::uint64_t& capacity, std::uint64_t needed, std::uint64_t most) {
        // Also for elements that are not needed, so that no array is empty.
        constexpr std::uint64_t least = most_counted_in_cell;
        if (capacity >= least && needed <= capacity) return false;
        capacity = std::max({least, needed, std::min(with_room_to_grow(needed), most)});
        return true;
    }
};

}  // namespace meniscus::cuda
