// Prefix sums and sorts over device arrays, by CUB.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/cuda/errors.hpp"
#include "lattice/host_device.hpp"

namespace meniscus::cuda {

__extension__ using SortKey = unsigned __int128;

/// Number of triangles by level. Loaded and stored as one word of 16 bytes.
struct alignas(16) LevelCounts {
    std::uint32_t of[4];
    MENISCUS_HD friend LevelCounts operator+(const LevelCounts& a, const LevelCounts& b) {
        return {{a.of[0] + b.of[0], a.of[1] + b.of[1], a.of[2] + b.of[2], a.of[3] + b.of[3]}};
    }
};

/// Device memory that the algorithms work in; see scratch_bytes().
struct Scratch {
    std::byte* memory = nullptr;
    std::size_t bytes = 0;
};

/// The most bytes of scratch memory that a call below needs for these numbers of elements. particle_keys: with values;
/// brick_keys: without.
std::size_t scratch_bytes(std::size_t particle_keys, std::size_t brick_keys, std::size_t sums);

/// Element i becomes the sum of the elements before it.
void exclusive_sum(const Scratch& scratch, std::uint32_t* values, std::size_t n, cudaStream_t stream);
void exclusive_sum(const Scratch& scratch, std::uint64_t* values, std::size_t n, cudaStream_t stream);
void exclusive_sum(const Scratch& scratch, LevelCounts* values, std::size_t n, cudaStream_t stream);

/// Sorts the keys in `keys` by their lowest `bits`, with `room` for as many; returns which of the two holds them in the
/// end.
std::uint64_t* sort(const Scratch& scratch, std::uint64_t* keys, std::uint64_t* room, std::size_t n, unsigned bits,
                    cudaStream_t stream);

/// The same with a value for each key; equal keys keep their order.
struct SortedPairs {
    std::uint64_t* keys;
    std::uint32_t* values;
};
SortedPairs sort_with_values(const Scratch& scratch, SortedPairs pairs, SortedPairs room, std::size_t n, unsigned bits,
                             cudaStream_t stream);

}  // namespace meniscus::cuda
