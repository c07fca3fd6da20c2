// Functions that the 32 threads of a warp compute together. All of them must call these functions.
#pragma once

#include <cstdint>

#include "engine/cuda/launch.hpp"

namespace meniscus::cuda {

inline constexpr unsigned all_lanes = 0xFFFFFFFFU;

__device__ inline unsigned lane_index() {
    return threadIdx.x % warp_threads;
}
__device__ inline unsigned warp_in_block() {
    return threadIdx.x / warp_threads;
}

/// The number of lanes below this one in a set.
__device__ inline unsigned lanes_below(unsigned set) {
    return static_cast<unsigned>(__popc(set & ((1U << lane_index()) - 1)));
}

/// The first lane's value: a count that another warp may be changing must not part the lanes.
template <class Value>
__device__ inline Value same_in_all_lanes(Value value) {
    return __shfl_sync(all_lanes, value, 0);
}

/// A loop of the whole grid over all elements, neighboring ones in neighboring lanes.
struct GridLoop {
    std::uint64_t step = static_cast<std::uint64_t>(gridDim.x) * block_threads;
    std::uint64_t first =
        static_cast<std::uint64_t>(blockIdx.x) * block_threads + threadIdx.x;  ///< this thread's first element

    /// Calls visit(i) for this thread's elements below n. Index: 64 bits where there may be more than 2^32 of them.
    template <class Index = std::uint32_t, class Visit>
    __device__ void each(std::uint64_t n, const Visit& visit) const {
        for (std::uint64_t i = first; i < n; i += step) visit(static_cast<Index>(i));
    }
    /// Calls visit(i, whether i < n), the same number of times in all threads of a block, which give the same n.
    template <class Visit>
    __device__ void each_by_blocks(std::uint32_t n, const Visit& visit) const {
        for (std::uint64_t i = first; i - threadIdx.x < n; i += step) visit(static_cast<std::uint32_t>(i), i < n);
    }
    /// The same in all lanes of a warp.
    template <class Index = std::uint32_t, class Visit>
    __device__ void each_together(Index n, const Visit& visit) const {
        n = same_in_all_lanes(n);
        for (std::uint64_t i = first; i - lane_index() < n; i += step) visit(static_cast<Index>(i), i < n);
    }
};

/// Calls visit(i) for the elements below n, each by all lanes of one warp of the grid. Index: 32 bits, or 64 where
/// there may be more than 2^32 of them.
template <class Index, class Visit>
__device__ void each_by_warp(Index n, const Visit& visit) {
    n = same_in_all_lanes(n);
    const std::uint64_t warps = static_cast<std::uint64_t>(gridDim.x) * block_warps;
    // The compiler shall know that all lanes have the same: it then takes them for being together.
    const std::uint32_t warp = same_in_all_lanes(warp_in_block());
    for (std::uint64_t i = static_cast<std::uint64_t>(blockIdx.x) * block_warps + warp; i < n; i += warps)
        visit(static_cast<Index>(i));
}

/// The sum of the values of the lanes below; `total` becomes that of all.
__device__ inline std::uint32_t sum_of_lanes_below(std::uint32_t value, std::uint32_t& total) {
    std::uint32_t sum = value;
    for (unsigned distance = 1; distance < warp_threads; distance *= 2) {
        const std::uint32_t below = __shfl_up_sync(all_lanes, sum, distance);
        if (lane_index() >= distance) sum += below;
    }
    total = __shfl_sync(all_lanes, sum, warp_threads - 1);
    return sum - value;
}

/// The lane whose share element i is, where each lane's share begins with element `below`; i is less than the sum.
__device__ inline unsigned lane_with(std::uint32_t i, std::uint32_t below) {
    unsigned lane = 0;
    for (unsigned step = warp_threads / 2; step > 0; step /= 2)
        if (__shfl_sync(all_lanes, below, static_cast<int>(lane + step)) <= i) lane += step;
    return lane;
}

/// Takes `count` places at the end of a list for every lane; returns the lane's first one. The order of warps is left
/// to chance.
template <class Counter>
__device__ inline Counter take_places(Counter* counter, std::uint32_t count) {
    std::uint32_t total = 0;
    const std::uint32_t below = sum_of_lanes_below(count, total);
    Counter first = 0;
    if (lane_index() == 0 && total != 0) first = atomicAdd(counter, static_cast<Counter>(total));
    return __shfl_sync(all_lanes, first, 0) + below;
}

/// A word of shared memory that other threads of the block change by atomic operations. A plain look is a race to
/// compute-sanitizer alone, so that no test without a GPU tells the two apart.
__device__ inline std::uint32_t look_among_atomics(const std::uint32_t& shared) {
#ifdef __CUDA_ARCH__
    std::uint32_t seen;
    asm volatile("ld.relaxed.cta.shared.u32 %0, [%1];"
                 : "=r"(seen)
                 : "r"(static_cast<std::uint32_t>(__cvta_generic_to_shared(&shared))));
    return seen;
#else
    return shared;  // the device in software, whose threads take turns
#endif
}

/// The sum of the lanes' values, in all lanes.
__device__ inline std::uint32_t sum_of_lanes(std::uint32_t value) {
    for (unsigned distance = warp_threads / 2; distance > 0; distance /= 2)
        value += __shfl_xor_sync(all_lanes, value, static_cast<int>(distance));
    return value;
}

/// Adds the lanes' values to a count.
template <class Value>
__device__ void add_of_lanes(unsigned long long* counter, Value value) {
    for (unsigned distance = warp_threads / 2; distance > 0; distance /= 2)
        value += __shfl_xor_sync(all_lanes, value, static_cast<int>(distance));
    if (lane_index() == 0 && value != 0) atomicAdd(counter, static_cast<unsigned long long>(value));
}

__device__ inline unsigned reduce_or(unsigned bits) {
    for (unsigned distance = warp_threads / 2; distance > 0; distance /= 2)
        bits |= __shfl_xor_sync(all_lanes, bits, static_cast<int>(distance));
    return bits;
}
__device__ inline float reduce_min(float value) {
    for (unsigned distance = warp_threads / 2; distance > 0; distance /= 2) {
        const float other = __shfl_xor_sync(all_lanes, value, static_cast<int>(distance));
        value = other < value ? other : value;
    }
    return value;
}
__device__ inline float reduce_max(float value) {
    return -reduce_min(-value);
}

}  // namespace meniscus::cuda
