// How much room the arrays of a frame have, and how that grows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lattice/host_device.hpp"

namespace meniscus::cuda {

/// What a frame may need more of than there is room for. How much is known on the device alone, in this order.
enum class Resource : std::uint8_t { particle_bricks, reached_bricks, bricks, blocks, samples, vertices, triangles };
inline constexpr std::size_t resource_count = 7;

struct Capacities {
    std::uint64_t particles = 0;
    std::array<std::uint64_t, resource_count> of{};

    MENISCUS_HD std::uint64_t operator[](Resource r) const { return of[static_cast<std::size_t>(r)]; }

    /// Grows to what is needed and an eighth more; returns whether there was too little.
    bool grow_to(std::uint64_t needed_particles, const unsigned long long (&needed)[resource_count]) {
        bool grown = grow(particles, needed_particles);
        for (std::size_t r = 0; r < resource_count; ++r) grown |= grow(of[r], needed[r]);
        return grown;
    }

private:
    static bool grow(std::uint64_t& capacity, std::uint64_t needed) {
        constexpr std::uint64_t least = 256;  // also of what is not needed at all, so that no array is empty
        if (capacity >= least && needed <= capacity) return false;
        capacity = needed + needed / 8 > least ? needed + needed / 8 : least;
        return true;
    }
};

}  // namespace meniscus::cuda
