// Counters that the whole grid shares: a block adds up first, and one of its threads adds the sum. Additions to one
// address come one after another.
#pragma once

#include <cstdint>

#include "engine/cuda/warp.hpp"

namespace meniscus::cuda {

/// Shared memory of a block. All threads of the block must call.
struct BlockCounter {
    unsigned long long of_warp[block_warps];
    unsigned long long first;

    /// Adds the threads' values to a counter.
    template <class Number>
    __device__ void add(Number* counter, Number value) {
        for (unsigned distance = warp_threads / 2; distance > 0; distance /= 2)
            value += __shfl_xor_sync(all_lanes, value, static_cast<int>(distance));
        if (lane_index() == 0) of_warp[warp_in_block()] = value;
        __syncthreads();
        if (threadIdx.x == 0) {
            Number sum = 0;
            for (unsigned w = 0; w < block_warps; ++w) sum += static_cast<Number>(of_warp[w]);
            if (sum != 0) atomicAdd(counter, sum);
        }
        // The next sum takes the place of this one.
        __syncthreads();
    }

    /// Takes `count` places at the end of a list for every thread; returns the thread's first one. The order of blocks
    /// is left to chance.
    template <class Number>
    __device__ Number take_places(Number* counter, std::uint32_t count) {
        std::uint32_t total = 0;
        const std::uint32_t below = sum_of_lanes_below(count, total);
        if (lane_index() == 0) of_warp[warp_in_block()] = total;
        __syncthreads();
        if (threadIdx.x == 0) {
            Number sum = 0;
            for (unsigned w = 0; w < block_warps; ++w) {
                const auto own = static_cast<Number>(of_warp[w]);
                of_warp[w] = sum;
                sum += own;
            }
            first = sum == 0 ? 0 : atomicAdd(counter, sum);
        }
        __syncthreads();
        const auto begin = static_cast<Number>(first + of_warp[warp_in_block()]);
        // The next total takes the place of what the warp has read.
        __syncwarp();
        return begin + below;
    }
};

}  // namespace meniscus::cuda
