// A particle's level and ParticleKey in one number.
#pragma once

#include <cstdint>

#include "engine/cuda/scans.hpp"
#include "lattice/host_device.hpp"
#include "particles/particle_key.hpp"

namespace meniscus::cuda {

inline constexpr int place_bits = 3 * place_axis_bits;
inline constexpr int cell_bits = 3 * brick_axis_bits + brick_index_bits;
static_assert(place_bits + cell_bits + 2 == 128);

__device__ inline SortKey sort_key(unsigned level, const ParticleKey& key) {
    return (SortKey{level} << cell_bits | key.cell) << place_bits | key.place;
}
__device__ inline unsigned key_level(SortKey key) {
    return static_cast<unsigned>(key >> (place_bits + cell_bits));
}
__device__ inline ParticleKey particle_key(SortKey key) {
    constexpr std::uint64_t place_mask = (std::uint64_t{1} << place_bits) - 1;
    constexpr std::uint64_t cell_mask = (std::uint64_t{1} << cell_bits) - 1;
    return {static_cast<std::uint64_t>(key >> place_bits) & cell_mask, static_cast<std::uint64_t>(key) & place_mask};
}

}  // namespace meniscus::cuda
